#include "annotate/write.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <tuple>

#include "annotate/copy.hpp"
#include "annotate/extend.hpp"
#include "data/files/file.hpp"
#include "data/text/text.hpp"
#include "recordings/parquet/table.hpp"

namespace etlc::annotate {

namespace {

using diag::Code;
using diag::Failure;
using recordings::in_part;
using recordings::Table;
using Json = nlohmann::ordered_json;

constexpr const char* kInfo = "meta/info.json";
constexpr const char* kSuccess = "next.success";
constexpr const char* kPersistent = "language_persistent";
constexpr const char* kEvents = "language_events";
constexpr std::uint64_t kMaxInfoBytes = 64U << 20U;

/// A row of the file of progress.
struct ProgressRow {
    std::int64_t index = 0;
    std::int64_t episode = 0;
    std::int64_t frame = 0;
    float progress = 0;
};

/// The columns of one file of rows.
class FileColumns {
public:
    FileColumns(const Writing& writing, const Judged& judged, std::vector<ProgressRow>& progress)
        : writing_(writing), judged_(judged), progress_(progress) {}

    diag::Result<std::vector<NewColumn>> read(const std::string& file) {
        const std::vector<std::string> names = {"episode_index", "timestamp", "index"};
        const bool needed[] = {true, !writing_.wanted.subtasks.empty(),
                               !writing_.wanted.progress.empty()};
        auto table = Table::open(file, names);
        if (!table) return table.failure();
        for (std::size_t i = 0; i < names.size(); ++i) {
            const Table::Column& column = (*table)->columns()[i];
            if (needed[i] && (!column.exists || column.is_text || column.is_list))
                return Failure{Code::unreadable_dataset, fmt::format("has no column {} of numbers",
                                                                     data::in_quotes(names[i]))};
        }
        std::vector<Table::Cell> cells;
        for (;;) {
            const auto more = (*table)->next(cells);
            if (!more) return more.failure();
            if (!*more) break;
            const auto whole = [&](std::size_t i) {
                return cells[i].numbers.empty() ? -1
                                                : static_cast<std::int64_t>(cells[i].numbers[0]);
            };
            if (whole(0) != now_)
                if (auto failure = end_run()) return *failure;
            now_ = whole(0);
            times_.push_back(cells[1].numbers.empty() ? 0
                                                      : static_cast<float>(cells[1].numbers[0]));
            add_row(whole(2));
        }
        if (auto failure = end_run()) return *failure;
        return columns();
    }

private:
    void add_row(std::int64_t index) {
        const std::uint64_t row = rows_[now_]++;
        const auto found = judged_.episodes.find(static_cast<std::uint64_t>(now_));
        const Episode* const episode = found == judged_.episodes.end() ? nullptr : &found->second;
        success_ += episode != nullptr && episode->outcome == Episode::Outcome::success &&
                            row >= episode->succeeds
                        ? '\1'
                        : '\0';
        if (writing_.wanted.progress.empty()) return;
        const bool is_known = episode != nullptr && row < episode->places.size();
        progress_.push_back({index, now_, static_cast<std::int64_t>(row),
                             is_known ? judged_.progress(episode->places[row])
                                      : std::numeric_limits<float>::quiet_NaN()});
    }

    /// Ends the rows of an episode, which all have the list of the episode. Fails where the episode
    /// has other rows in the file: the times of its subtasks are those of successive rows.
    std::optional<Failure> end_run() {
        if (times_.empty()) return std::nullopt;
        const auto judged = judged_.episodes.find(static_cast<std::uint64_t>(now_));
        if (rows_[now_] != times_.size() ||
            (judged != judged_.episodes.end() && judged->second.rows != times_.size()))
            return Failure{Code::unreadable_dataset,
                           fmt::format("has rows of episode {} that do not follow each other, or "
                                       "others than before",
                                       now_)};
        NewColumn::Run run{times_.size(), {}};
        const Wanted& wanted = writing_.wanted;
        if (judged != judged_.episodes.end())
            for (const auto& [row, subtask] : judged->second.subtasks)
                run.sayings.push_back({times_[row], subtask < wanted.subtasks.size()
                                                        ? wanted.subtasks[subtask]
                                                        : wanted.between});
        lists_.push_back(std::move(run));
        times_.clear();
        return std::nullopt;
    }

    std::vector<NewColumn> columns() {
        std::vector<NewColumn> columns;
        std::uint64_t all = 0;
        for (const NewColumn::Run& run : lists_) all += run.rows;
        if (!writing_.wanted.success.empty())
            columns.push_back({NewColumn::Kind::boolean, kSuccess, std::move(success_), {}});
        if (writing_.wanted.subtasks.empty()) return columns;
        columns.push_back({NewColumn::Kind::language, kPersistent, "", std::move(lists_)});
        columns.push_back({NewColumn::Kind::events, kEvents, "", {{all, {}}}});
        return columns;
    }

    const Writing& writing_;
    const Judged& judged_;
    std::vector<ProgressRow>& progress_;
    std::map<std::int64_t, std::uint64_t> rows_;  ///< so far, per episode
    std::int64_t now_ = -1;                       ///< the episode
    std::vector<float> times_;                    ///< of its rows
    std::string success_;
    std::vector<NewColumn::Run> lists_;
};

std::string progress_file(const Writing& writing, std::vector<ProgressRow> rows) {
    std::sort(rows.begin(), rows.end(), [](const ProgressRow& a, const ProgressRow& b) {
        return std::tie(a.index, a.episode, a.frame) < std::tie(b.index, b.episode, b.frame);
    });
    using Kind = NewColumn::Kind;
    std::vector<NewColumn> columns = {{Kind::int64, "index", "", {}},
                                      {Kind::int64, "episode_index", "", {}},
                                      {Kind::int64, "frame_index", "", {}},
                                      {Kind::float32, "progress_sparse", "", {}}};
    for (const ProgressRow& row : rows) {
        append(columns[0].values, row.index);
        append(columns[1].values, row.episode);
        append(columns[2].values, row.frame);
        append(columns[3].values, row.progress);
    }
    return new_file(rows.size(),
                    {{"etlc", writing.version},
                     {"spec", writing.spec},
                     {"spec_hash", writing.spec_hash},
                     {"monitor", writing.wanted.progress}},
                    columns);
}

diag::Result<Json> read_json(const std::string& path) {
    const auto bytes = data::read_file(path, kMaxInfoBytes, Code::unreadable_dataset);
    if (!bytes) return bytes.failure();
    Json json = Json::parse(*bytes, nullptr, false);
    if (!json.is_object()) return Failure{Code::unreadable_dataset, "is not JSON, or no object"};
    return json;
}

/// Returns meta/info.json with the new features.
diag::Result<Json> new_info(const Writing& writing) {
    auto info = read_json(writing.set.path_of(kInfo));
    if (!info) return info;
    const auto add = [&](const char* name, const char* type) {
        (*info)["features"][name] = {
            {"dtype", type}, {"shape", Json::array({1})}, {"names", nullptr}};
    };
    if (!writing.wanted.success.empty()) add(kSuccess, "bool");
    if (!writing.wanted.subtasks.empty()) add(kPersistent, "language");
    if (!writing.wanted.subtasks.empty()) add(kEvents, "language");
    return info;
}

/// Returns what was annotated, beside what an earlier call annotated.
Json provenance(const Writing& writing, const Judged& judged) {
    auto old = read_json(writing.set.path_of(kProvenance));
    Json all = old ? std::move(*old) : Json::object();
    const auto begin = [&](const char* what) -> Json& {
        return all[what] = {{"etlc", writing.version},
                            {"spec", writing.spec},
                            {"spec_hash", writing.spec_hash}};
    };
    const Wanted& wanted = writing.wanted;
    if (!wanted.success.empty()) {
        Json& success = begin(kSuccess);
        success["monitor"] = wanted.success;
        success["undecided"] = undecided(writing.set, judged);
    }
    if (!wanted.subtasks.empty()) {
        Json& subtasks = begin(kPersistent);
        subtasks["subtasks"] = wanted.subtasks;
        subtasks["between"] = wanted.between;
    }
    if (!wanted.progress.empty()) {
        Json& progress = begin(kProgress);
        progress["monitor"] = wanted.progress;
        progress["phases"] = judged.phases;
        progress["reached_at"] = std::vector<double>(judged.steps.begin() + 1, judged.steps.end());
    }
    return all;
}

}  // namespace

std::vector<std::uint64_t> undecided(const recordings::Dataset& set, const Judged& judged) {
    std::vector<std::uint64_t> indices;
    for (const recordings::DatasetEpisode& episode : set.episodes()) {
        const auto found = judged.episodes.find(episode.index);
        if (found == judged.episodes.end() || found->second.outcome == Episode::Outcome::undecided)
            indices.push_back(episode.index);
    }
    return indices;
}

std::optional<Failure> refusal(const recordings::Dataset& set, const Wanted& wanted) {
    const auto has = [&](const char* name) {
        return std::any_of(set.features().begin(), set.features().end(),
                           [&](const recordings::Feature& f) { return f.name == name; });
    };
    const auto refuse = [](const std::string& why) { return Failure{Code::not_annotated, why}; };
    for (const char* name : {kSuccess, kPersistent, kEvents}) {
        const bool is_new = name == kSuccess ? !wanted.success.empty() : !wanted.subtasks.empty();
        if (is_new && has(name))
            return refuse(fmt::format("has the feature {} already, which is not replaced",
                                      data::in_quotes(name)));
    }
    if (!wanted.subtasks.empty() && has("subtask_index"))
        return refuse(
            "has the feature 'subtask_index', which LeRobot drops where it finds "
            "language_persistent: remove it first");
    if (!wanted.subtasks.empty() && set.major_version() < 3)
        return refuse(
            "is of the version 2, in which LeRobot reads no language_persistent: convert "
            "it to v3.0 first");
    if (!wanted.progress.empty() && !data::why_unreadable(set.path_of(kProgress)))
        return refuse(fmt::format("has the file {} already: remove it first", kProgress));
    return std::nullopt;
}

diag::Result<Written> write(const Writing& writing, const Judged& judged) {
    std::set<std::string> files;
    for (const recordings::DatasetEpisode& episode : writing.set.episodes())
        files.insert(episode.rows);
    const bool has_columns = !writing.wanted.success.empty() || !writing.wanted.subtasks.empty();
    std::set<std::string> changed = {kProvenance};
    if (has_columns) changed.insert(files.begin(), files.end());
    if (has_columns) changed.insert(kInfo);
    DatasetCopy copy(writing.set.folder(), writing.output, changed);
    if (auto failure = copy.fill()) return *failure;
    std::vector<ProgressRow> progress;
    for (const std::string& file : files) {
        auto columns = FileColumns(writing, judged, progress).read(writing.set.path_of(file));
        if (!columns) return in_part(file, columns.failure());
        if (!has_columns) continue;
        if (auto failure = copy.extend(file, *columns)) return in_part(file, *failure);
    }
    std::vector<std::pair<std::string, std::string>> others;
    if (!writing.wanted.progress.empty())
        others.emplace_back(kProgress, progress_file(writing, std::move(progress)));
    if (has_columns) {
        const auto info = new_info(writing);
        if (!info) return in_part(kInfo, info.failure());
        others.emplace_back(kInfo, info->dump(4) + "\n");
    }
    others.emplace_back(kProvenance, provenance(writing, judged).dump(4) + "\n");
    for (const auto& [file, bytes] : others)
        if (auto failure = copy.write(file, bytes)) return in_part(file, *failure);
    if (auto failure = copy.commit()) return *failure;
    return Written{has_columns ? files.size() : 0, copy.copied(), copy.linked()};
}

}  // namespace etlc::annotate
