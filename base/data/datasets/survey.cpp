#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "data/datasets/dataset.hpp"
#include "data/parquet/table.hpp"
#include "data/text/quote.hpp"

namespace etlc::data {
namespace {

/// How far a row may be from its time, in steps: as far as float32 may round, and more.
constexpr double kTolerance = 0.1;

/// Of a row, what is not as its place says.
std::string fault_of_row(std::uint64_t row, const std::vector<Table::Column>& columns,
                         const std::vector<Table::Cell>& cells, double fps) {
    const Table::Cell& frame = cells[1];
    const Table::Cell& time = cells[2];
    const auto place = static_cast<double>(row);
    if (columns[1].is_there && (frame.is_null || frame.numbers[0] != place))
        return fmt::format("row {} has the frame_index {}", row,
                           frame.is_null ? "null" : fmt::format("{}", frame.numbers[0]));
    const double time_of_row =
        time.is_null ? std::numeric_limits<double>::quiet_NaN() : time.numbers[0];
    if (columns[2].is_there && !(std::abs(time_of_row * fps - place) <= kTolerance))
        return fmt::format("row {} is at {} s, expected it at {:.6g} s", row,
                           time.is_null ? "null" : fmt::format("{:.6g}", time_of_row), place / fps);
    return "";
}

}  // namespace

void Dataset::survey(const std::string& rows) {
    std::map<std::uint64_t, Found>& found = found_[rows];
    const auto give_up = [&](const std::string& why) {
        for (const DatasetEpisode& episode : episodes_)
            if (episode.rows == rows)
                found[episode.index] = {episode.length, fmt::format("{}: {}", rows, why)};
    };
    auto table = Table::open(path_of(rows), {"episode_index", "frame_index", "timestamp"});
    if (!table) return give_up(table.failure().message);
    const auto& columns = (*table)->columns();
    if (!columns[0].is_there) return give_up("has no column 'episode_index'");
    for (const Table::Column& column : columns)
        if (column.is_text || column.is_list)
            return give_up(
                "has an episode_index, frame_index or timestamp that is no number a row");
    std::vector<Table::Cell> cells;
    double last = -1;
    for (;;) {
        const auto more = (*table)->next(cells);
        if (!more) return give_up(more.failure().message);
        if (!*more) break;
        const double index = cells[0].is_null ? -1 : cells[0].numbers[0];
        if (!(index >= 0) || index > 1e15) return give_up("has a row of no episode");
        Found& one = found[static_cast<std::uint64_t>(index)];
        if (one.lack.empty() && one.rows > 0 && last != index)
            one.lack = "its rows are apart from each other";
        if (one.lack.empty()) one.lack = fault_of_row(one.rows, columns, cells, fps_);
        ++one.rows;
        last = index;
    }
    for (const DatasetEpisode& episode : episodes_) {
        if (episode.rows != rows) continue;
        Found& one = found[episode.index];
        if (one.rows != episode.length)
            one.lack = fmt::format("{} has {} of it, the metadata say {}", rows,
                                   diag::counted(one.rows, "row"), episode.length);
        else if (!one.lack.empty())
            one.lack = fmt::format("{}: {}", rows, one.lack);
        else if (one.rows == 0)
            one.lack = "it has no row";
    }
}

const Dataset::Found& Dataset::found(const DatasetEpisode& episode) {
    if (found_.find(episode.rows) == found_.end()) survey(episode.rows);
    return found_[episode.rows][episode.index];
}

std::string Dataset::lack(const DatasetEpisode& episode) {
    const std::lock_guard guard(lock_);
    return found(episode).lack;
}

}  // namespace etlc::data
