#include "data/datasets/trace.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "data/parquet/table.hpp"
#include "data/text/number.hpp"
#include "data/text/quote.hpp"
#include "data/traces/trace_formats.hpp"

namespace etlc::data {
namespace {

using diag::Code;
using diag::Failure;

/// Returns the column of a channel; for "action[3]" also the place in it.
ElementName wanted_of(const Channel& channel) {
    if (channel.kind == Channel::Kind::vector) return {channel.name, {}};
    return element_name(channel.name);
}

/// The rows of all channels, which read them in step.
class JointCells {
public:
    JointCells(std::unique_ptr<Table> table, std::uint64_t steps)
        : table_(std::move(table)), steps_(steps) {}

    /// Returns a cell of row `step`, which is the current or the next one.
    diag::Result<const Table::Cell*> cell(std::uint64_t step, std::size_t column) {
        if (step < taken_) return &cells_[column];
        const auto more = table_->next(cells_);
        if (!more) return more.failure();
        if (!*more) return changed();
        if (++taken_ < steps_) return &cells_[column];
        std::vector<Table::Cell> behind;
        const auto end = table_->next(behind);
        if (!end) return end.failure();
        if (*end) return changed();
        return &cells_[column];
    }

private:
    static Failure changed() {
        return {Code::unreadable_dataset, "has other rows than before: it has changed meanwhile"};
    }

    std::unique_ptr<Table> table_;
    std::uint64_t steps_;
    std::uint64_t taken_ = 0;
    std::vector<Table::Cell> cells_;
};

class CellRows final : public Rows {
public:
    CellRows(std::shared_ptr<JointCells> joint, std::size_t column, ElementName wanted,
             std::uint32_t width)
        : joint_(std::move(joint)), column_(column), wanted_(std::move(wanted)), row_(width) {}

    diag::Result<const double*> next() override {
        const auto cell = joint_->cell(step_++, column_);
        if (!cell) return cell.failure();
        if ((*cell)->is_null) {
            std::fill(row_.begin(), row_.end(), std::numeric_limits<double>::quiet_NaN());
            return row_.data();
        }
        const std::vector<double>& numbers = (*cell)->numbers;
        if (wanted_.element && *wanted_.element < numbers.size()) {
            row_[0] = numbers[*wanted_.element];
            return row_.data();
        }
        if (wanted_.element || numbers.size() != row_.size())
            return Failure{
                Code::trace_shape,
                fmt::format("has {} in row {} of the episode, expected {}",
                            diag::counted(numbers.size(), "element"), step_ - 1,
                            wanted_.element ? fmt::format("more than {}", *wanted_.element)
                                            : std::to_string(row_.size()))};
        std::copy(numbers.begin(), numbers.end(), row_.begin());
        return row_.data();
    }

private:
    std::shared_ptr<JointCells> joint_;
    std::size_t column_;
    ElementName wanted_;
    std::vector<double> row_;
    std::uint64_t step_ = 0;
};

/// Refuses a column that is missing, or does not hold numbers.
std::optional<Failure> refused(const Dataset& set, const Channel& channel,
                               const ElementName& wanted, const Table::Column& column) {
    std::vector<std::string> columns;
    for (const Feature& feature : set.features()) {
        const bool is_picture = feature.type == "video" || feature.type == "image";
        if (is_picture && feature.name == wanted.array)
            return Failure{Code::no_such_channel,
                           fmt::format("{} is a camera; `etlc embed` makes embeddings of it",
                                       in_quotes(wanted.array))};
        if (!is_picture) columns.push_back(feature.name);
    }
    if (!column.exists) {
        return Failure{Code::no_such_channel,
                       fmt::format("no column {}{}; there are {}", in_quotes(wanted.array),
                                   suggestion(wanted.array, columns), listed(columns))};
    }
    if (column.is_text)
        return Failure{Code::trace_elements, fmt::format("column {} holds text, expected numbers",
                                                         in_quotes(wanted.array))};
    if (column.is_bool && channel.kind != Channel::Kind::boolean)
        return Failure{Code::trace_elements,
                       fmt::format("column {} has bool elements, expected numbers: the input is "
                                   "no bool",
                                   in_quotes(wanted.array))};
    return std::nullopt;
}

std::optional<Failure> refuse_empty(const DatasetPath& path) {
    if (path.first < path.end) return std::nullopt;
    return Failure{Code::no_such_episode,
                   fmt::format("'{}:{}' ends before it begins: {} are the episodes 0 to 49",
                               path.first, path.end, in_quotes(path.folder + ":0:50"))};
}

Failure in_rows(const DatasetEpisode& episode, Failure failure) {
    failure.message = fmt::format("{}: {}", episode.rows, failure.message);
    return failure;
}

}  // namespace

diag::Result<SoundEpisode> find_episode(const std::string& path) {
    const auto which = dataset_path(path);
    if (!which) return Failure{Code::unreadable_dataset, "is no episode of a data set"};
    auto set = Dataset::known(which->folder);
    if (!set) return set.failure();
    if (auto failure = refuse_empty(*which)) return *failure;
    const bool is_one = which->end == which->first + 1;
    if (!is_one && (*set)->episodes().size() != 1)
        return Failure{
            Code::no_such_episode,
            fmt::format("is a data set of {}: name one, {}",
                        diag::counted((*set)->episodes().size(), "episode"),
                        in_quotes(episode_path(which->folder, (*set)->episodes()[0].index)))};
    const DatasetEpisode* const episode =
        is_one ? (*set)->episode(which->first) : &(*set)->episodes()[0];
    if (episode == nullptr)
        return Failure{
            Code::no_such_episode,
            fmt::format("is not an episode of the data set; it has {}, {} to {}",
                        diag::counted((*set)->episodes().size(), "episode"),
                        (*set)->episodes().front().index, (*set)->episodes().back().index)};
    if (const std::string why = (*set)->lack(*episode); !why.empty())
        return Failure{Code::no_such_episode, why};
    return SoundEpisode{*set, episode};
}

diag::Result<std::unique_ptr<Trace>> open_dataset_trace(const std::string& path,
                                                        const std::vector<Channel>& channels) {
    const auto found = find_episode(path);
    if (!found) return found.failure();
    const DatasetEpisode& episode = *found->episode;
    std::vector<ElementName> wanted;
    std::vector<std::string> names;
    for (const Channel& channel : channels) {
        wanted.push_back(wanted_of(channel));
        names.push_back(wanted.back().array);
    }
    auto table =
        Table::open(found->set->path_of(episode.rows), names, "episode_index", episode.index);
    if (!table) return in_rows(episode, table.failure());
    std::vector<bool> there;
    for (std::size_t c = 0; c < channels.size(); ++c) {
        const Table::Column& column = (*table)->columns()[c];
        there.push_back(column.exists || !channels[c].optional);
        if (!there[c]) continue;
        if (auto failure = refused(*found->set, channels[c], wanted[c], column)) return *failure;
    }
    const auto joint = std::make_shared<JointCells>(std::move(*table), episode.length);
    std::vector<Feed> feeds;
    for (std::size_t c = 0; c < channels.size(); ++c) {
        feeds.push_back({channels[c], episode.length, nullptr});
        if (there[c])
            feeds[c].rows = std::make_unique<CellRows>(joint, c, wanted[c], channels[c].width);
    }
    return open_array_trace(std::move(feeds));
}

diag::Result<std::uint64_t> rows_a_step(const Dataset& set, double rate) {
    constexpr double kRateTolerance = 0.005;  // as for videos: 29.97 frames a second are 30
    if (rate == 0) return std::uint64_t{1};
    const double rows = set.fps() / rate;
    const double nearest = std::max(1.0, std::round(rows));
    if (std::abs(rows / nearest - 1) > kRateTolerance)
        return Failure{Code::dataset_out_of_step,
                       fmt::format("has {:.6g} rows a second, expected a multiple of the {:.6g} "
                                   "steps of the spec",
                                   set.fps(), rate)};
    return static_cast<std::uint64_t>(nearest);
}

diag::Result<std::vector<std::string>> find_dataset_episodes(const DatasetPath& path,
                                                             diag::Sink& sink) {
    const auto set = Dataset::known(path.folder);
    if (!set) return set.failure();
    if (auto failure = refuse_empty(path)) return *failure;
    const auto warn = [&](const std::string& message) {
        diag::Diagnostic found{Code::dataset_lacks, message, {}, path.folder};
        sink.report(std::move(found));
    };
    for (const std::string& contradiction : (*set)->contradictions()) warn(contradiction);
    std::vector<std::string> paths;
    for (const DatasetEpisode& episode : (*set)->episodes()) {
        if (episode.index < path.first || episode.index >= path.end) continue;
        const std::string why = (*set)->lack(episode);
        if (why.empty()) paths.push_back(episode_path(path.folder, episode.index));
        if (!why.empty()) warn(fmt::format("episode {} is left out: {}", episode.index, why));
    }
    if (paths.empty())
        return Failure{
            Code::no_such_episode,
            fmt::format("has none of these episodes as its metadata say; it has {}, {} "
                        "to {}",
                        diag::counted((*set)->episodes().size(), "episode"),
                        (*set)->episodes().front().index, (*set)->episodes().back().index)};
    return paths;
}

std::optional<Failure> check_rate(const std::string& path, double step_seconds) {
    if (step_seconds == 0) return std::nullopt;
    const auto which = dataset_path(path);
    if (!which) return std::nullopt;
    const auto set = Dataset::known(which->folder);
    if (!set) return set.failure();
    const auto stride = rows_a_step(**set, 1 / step_seconds);
    if (!stride) return stride.failure();
    if (*stride == 1) return std::nullopt;
    return Failure{
        Code::dataset_out_of_step,
        fmt::format("has {:.6g} rows a second, the spec {:.6g} steps; `etlc embed` makes "
                    "episodes of one row in {}",
                    (*set)->fps(), 1 / step_seconds, *stride)};
}

}  // namespace etlc::data
