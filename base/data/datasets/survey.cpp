#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "data/datasets/dataset.hpp"
#include "data/parquet/table.hpp"
#include "data/quote.hpp"

namespace etlc::data {
namespace {

/// How far a row may be from its time, in steps: as far as float32 may round, and more.
constexpr double kTolerance = 0.1;

/// The rows of an episode, as they come.
struct Seen {
    std::uint64_t rows = 0;
    double begin = 0;
    std::string lack;

    void find(const std::string& what) {
        if (lack.empty()) lack = what;
    }
};

void check_row(Seen& seen, const std::vector<Table::Cell>& cells, double fps) {
    const Table::Cell& frame = cells[1];
    const Table::Cell& time = cells[2];
    if (!frame.is_null && frame.numbers[0] != static_cast<double>(seen.rows))
        seen.find(fmt::format("row {} has the frame_index {}", seen.rows, frame.numbers[0]));
    if (!time.is_null) {
        if (seen.rows == 0) seen.begin = time.numbers[0];
        const double place = seen.begin + static_cast<double>(seen.rows) / fps;
        if (!(std::abs(time.numbers[0] - place) * fps <= kTolerance))
            seen.find(fmt::format("row {} is at {:.6g} s, expected it at {:.6g} s", seen.rows,
                                  time.numbers[0], place));
    }
    ++seen.rows;
}

}  // namespace

void Dataset::survey(const std::string& rows) {
    std::map<std::uint64_t, std::string>& lacks = lacks_[rows];
    std::map<std::uint64_t, Seen> seen;
    const auto give_up = [&](const std::string& why) {
        for (const DatasetEpisode& episode : episodes_)
            if (episode.rows == rows) lacks[episode.index] = fmt::format("{}: {}", rows, why);
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
        Seen& one = seen[static_cast<std::uint64_t>(index)];
        if (one.rows > 0 && last != index) one.find("its rows are apart from each other");
        check_row(one, cells, fps_);
        last = index;
    }
    for (const DatasetEpisode& episode : episodes_) {
        if (episode.rows != rows) continue;
        Seen& one = seen[episode.index];
        if (one.rows != episode.length)
            lacks[episode.index] = fmt::format("{} has {} of it, the metadata say {}", rows,
                                               diag::counted(one.rows, "row"), episode.length);
        else if (!one.lack.empty())
            lacks[episode.index] = fmt::format("{}: {}", rows, one.lack);
        else if (one.rows == 0)
            lacks[episode.index] = "it has no row";
    }
}

std::string Dataset::lack(const DatasetEpisode& episode) {
    const std::lock_guard guard(lock_);
    if (lacks_.find(episode.rows) == lacks_.end()) survey(episode.rows);
    const auto& lacks = lacks_[episode.rows];
    const auto found = lacks.find(episode.index);
    return found == lacks.end() ? "" : found->second;
}

}  // namespace etlc::data
