// Looks up the episodes and predicates of tables of labels, and compares the labels with each
// other.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <set>
#include <utility>

#include "data/files/file.hpp"
#include "data/text/text.hpp"
#include "episodes/labels/episode_names.hpp"
#include "episodes/labels/labels.hpp"
#include "episodes/labels/table.hpp"
#include "recordings/datasets/dataset.hpp"
#include "recordings/episodes.hpp"

namespace etlc::episodes {

using diag::Code;

namespace {

namespace fs = std::filesystem;

/// A table and the episodes that it is about.
struct TableFile {
    std::string path;
    std::vector<std::string> episodes;
};

/// Returns the tables of the call. One that lies beside episodes is about these alone.
std::vector<TableFile> label_files(const LabelSources& sources,
                                   const std::vector<std::string>& episodes) {
    std::vector<TableFile> files;
    for (const std::string& path : sources.tables) files.push_back({path, episodes});
    if (!files.empty()) return files;
    std::map<std::string, std::vector<std::string>> folders;
    for (const std::string& episode : episodes) folders[folder_of(episode)].push_back(episode);
    for (auto& [folder, inside] : folders) {
        const std::string path = (fs::path(folder) / recordings::kLabelsFile).string();
        std::error_code ignored;
        if (fs::exists(path, ignored)) files.push_back({path, std::move(inside)});
    }
    return files;
}

std::vector<std::string> predicate_names(const std::vector<const check::Model*>& models) {
    std::vector<std::string> names;
    for (const check::Model* model : models)
        for (const check::Predicate& predicate : model->predicates)
            if (!predicate.name.empty()) names.push_back(predicate.name);
    return names;
}

}  // namespace

std::uint64_t step_at(double seconds, double step_seconds) {
    // Of a decimal that is exactly a tenth away, as 0.17 s is from step 5 at 30 Hz, the quotient in
    // double is a little more or less: 5.1000000000000005.
    constexpr double kRounding = 0.1 + 1e-6;
    constexpr double kMost = 9e15;
    return static_cast<std::uint64_t>(
        std::clamp(std::ceil(seconds / step_seconds - kRounding), 0.0, kMost));
}

/// Reads the sources of a call one after the other.
class LabelReader {
public:
    LabelReader(const std::vector<const check::Model*>& models,
                const std::vector<std::string>& episodes, diag::Sink& sink)
        : models_(models), predicates_(predicate_names(models)), episodes_(episodes), sink_(sink) {}

    void read_table(const TableFile& file, bool has_episodes) {
        auto source = data::open_file(file.path, data::Streams::taken);
        if (!source) {
            sink_.report(
                data::in_file({Code::unreadable_trace, source.failure().message}, file.path));
            return;
        }
        const auto table = data::within_memory([&] { return parse_labels(std::move(*source)); });
        if (!table) {
            sink_.report(data::in_file(table.failure(), file.path));
            return;
        }
        result_->tables_.push_back(file.path);
        Named names;
        for (const LabelRow& row : table->rows) names[normal(row.episode)];
        find_named(file.episodes, names);
        check_predicates(*table, file.path);
        if (has_episodes) check_names(*table, file, names);
        for (const LabelRow& row : table->rows) {
            const std::vector<std::size_t>& found = names.at(normal(row.episode));
            if (found.size() == 1) add(row, *table, file.path, file.episodes[found[0]]);
            if (has_too_many()) return;
        }
    }

    /// A folder labels the episodes in it, and in folders below it. One that all episodes lie
    /// below, and none lies in, tells none from another: it may be anywhere above the recordings.
    void read_folders() {
        const std::set<std::string> known(predicates_.begin(), predicates_.end());
        std::vector<std::vector<std::string>> folders;
        for (const std::string& episode : episodes_) folders.push_back(folders_of(episode));
        const std::size_t common = depth_in_common(folders);
        std::set<std::string> around;
        for (std::vector<std::string>& of : folders) {
            of.erase(of.begin(), of.begin() + static_cast<std::ptrdiff_t>(common));
            around.insert(of.begin(), of.end());
        }
        std::set<std::string> labelled;
        std::set_intersection(around.begin(), around.end(), known.begin(), known.end(),
                              std::inserter(labelled, labelled.end()));
        if (labelled.empty()) {
            sink_.report(data::in_file(
                {Code::nothing_to_label,
                 fmt::format("the episodes lie in {}, and none of these is a predicate; there are "
                             "{}",
                             data::listed({around.begin(), around.end()}),
                             data::listed({known.begin(), known.end()}))},
                "--label-by folder"));
            return;
        }
        for (std::size_t e = 0; e < episodes_.size(); ++e)
            for (const std::string& predicate : labelled) {
                const bool is_inside =
                    std::find(folders[e].begin(), folders[e].end(), predicate) != folders[e].end();
                result_->of_[episodes_[e]][predicate].push_back({0, LabelledSteps::kToTheEnd,
                                                                 is_inside ? Label::yes : Label::no,
                                                                 "--label-by folder"});
            }
    }

    /// Returns the labels if none is in error.
    std::shared_ptr<const LabelSet> finish() {
        for (auto& [episode, labels] : result_->of_)
            for (auto& [predicate, intervals] : labels) sort(episode, predicate, intervals);
        const bool is_empty = result_->tables_.empty() && result_->of_.empty();
        return sink_.has_errors() || is_empty ? nullptr : std::move(result_);
    }

private:
    static constexpr std::size_t kMostErrors = 10;

    /// Returns the number of folders that all episodes lie below, and none lies in.
    static std::size_t depth_in_common(const std::vector<std::vector<std::string>>& folders) {
        std::size_t common = folders.empty() ? 0 : folders[0].size();
        for (const std::vector<std::string>& of : folders) {
            const auto at =
                std::mismatch(of.begin(), of.end(), folders[0].begin(), folders[0].end());
            common = std::min<std::size_t>(common, at.first - of.begin());
        }
        const bool is_own = std::any_of(folders.begin(), folders.end(),
                                        [&](const auto& of) { return of.size() == common; });
        return is_own && common > 0 ? common - 1 : common;
    }

    bool has_too_many() const { return sink_.errors() >= kMostErrors; }

    static std::string normal(const std::string& name) {
        return fs::path(name).lexically_normal().string();
    }

    diag::Diagnostic& report(Code code, const std::string& path, std::uint32_t line,
                             std::string message) {
        return sink_.report(data::in_file({code, std::move(message), line, 1}, path));
    }

    void check_predicates(const LabelTable& table, const std::string& path) {
        std::set<std::string> unknown;
        for (const LabelRow& row : table.rows) {
            if (has_too_many()) return;
            const bool is_known = std::find(predicates_.begin(), predicates_.end(),
                                            row.predicate) != predicates_.end();
            if (row.predicate.empty() || is_known || !unknown.insert(row.predicate).second)
                continue;
            const std::string meant = data::suggestion(row.predicate, predicates_);
            report(Code::nothing_to_label, path, row.line,
                   fmt::format("{} predicate {}{}",
                               models_.size() == 1 ? "the spec has no" : "no spec has a",
                               data::in_quotes(row.predicate),
                               meant.empty() ? "; there are " + data::listed(predicates_) : meant));
        }
    }

    /// Reports names that no episode has, or several have. An episode outside the call is no
    /// mistake: calls share a table.
    void check_names(const LabelTable& table, const TableFile& file, const Named& names) {
        Named absent;
        for (const auto& [name, found] : names)
            if (found.empty()) absent[name];
        if (!absent.empty()) find_named(neighbours_of(file.episodes), absent);
        std::set<std::string> told;
        for (const LabelRow& row : table.rows) {
            if (has_too_many()) return;
            const std::string name = normal(row.episode);
            const std::vector<std::size_t>& found = names.at(name);
            if (found.size() == 1 || !told.insert(name).second) continue;
            if (found.size() > 1)
                report(Code::nothing_to_label, file.path, row.line,
                       fmt::format("{} names several episodes, {} and {}: write more of the path",
                                   data::in_quotes(row.episode),
                                   data::in_quotes(file.episodes[found[0]]),
                                   data::in_quotes(file.episodes[found[1]])));
            else if (absent.at(name).empty() &&
                     !is_episode_in(fs::path(file.path).parent_path().string(), row.episode))
                report(Code::nothing_to_label, file.path, row.line,
                       fmt::format("there is no episode {}{}", data::in_quotes(row.episode),
                                   meant_by(name, file.episodes)));
        }
    }

    /// Names an episode that is near, or else some that there are.
    static std::string meant_by(const std::string& name, const std::vector<std::string>& episodes) {
        constexpr std::size_t kMost = 1000;  // an edit distance is computed to each
        std::vector<std::string> names = episodes;
        names.resize(std::min(names.size(), kMost));
        names = shortest_names(names);
        const std::string meant = data::suggestion(fs::path(name).stem().string(), names);
        return meant.empty() ? "; there are " + data::listed(names) : meant;
    }

    void add(const LabelRow& row, const LabelTable& table, const std::string& path,
             const std::string& episode) {
        const std::string place = fmt::format("{}:{}", path, row.line);
        if (!row.group.empty()) {
            const auto [before, is_new] = groups_.emplace(episode, std::pair{row.group, place});
            if (before->second.first != row.group) {
                report(Code::contradictory_labels, path, row.line,
                       fmt::format("puts {} into the group {}", data::in_quotes(row.episode),
                                   data::in_quotes(row.group)))
                    .note(fmt::format("{} puts it into {}", before->second.second,
                                      data::in_quotes(before->second.first)));
                return;
            }
            result_->groups_[episode] = row.group;
        }
        if (row.predicate.empty()) return;
        const auto steps = steps_of(row, table, path, episode);
        if (steps)
            result_->of_[episode][row.predicate].push_back(
                {steps->first, steps->second, row.label, place});
    }

    std::optional<std::pair<std::uint64_t, std::uint64_t>> steps_of(const LabelRow& row,
                                                                    const LabelTable& table,
                                                                    const std::string& path,
                                                                    const std::string& episode) {
        double length = 1;
        if (table.in_seconds) {
            const auto found = step_length(path, row.line, episode);
            if (!found) return std::nullopt;
            length = *found;
        }
        const auto step = [&](double bound) {
            if (std::isinf(bound)) return LabelledSteps::kToTheEnd;
            return table.in_seconds ? step_at(bound, length) : static_cast<std::uint64_t>(bound);
        };
        const std::pair steps{step(row.start), step(row.end)};
        if (steps.first < steps.second) return steps;
        report(
            Code::malformed_labels, path, row.line,
            fmt::format("no step is from {} s up to but excluding {} s: there is one every {:.6g} "
                        "s",
                        row.start, row.end, length));
        return std::nullopt;
    }

    /// Returns the seconds from one step to the next, by the specs or by the data set.
    std::optional<double> step_length(const std::string& path, std::uint32_t line,
                                      const std::string& episode) {
        double length = models_.front()->step_seconds;
        for (const check::Model* model : models_)
            if (model->step_seconds != length) {
                if (!std::exchange(has_told_of_time_, true))
                    report(Code::steps_without_time, path, line,
                           "labels in seconds, but the specs differ in their rate");
                return std::nullopt;
            }
        if (length > 0) return length;
        if (const auto which = data::dataset_path(episode))
            if (const auto set = recordings::Dataset::known(which->folder);
                set && (*set)->fps() > 0)
                return 1 / (*set)->fps();
        if (!std::exchange(has_told_of_time_, true))
            report(Code::steps_without_time, path, line,
                   "labels in seconds, but the spec has no rate: declare one, such as 'rate 10 "
                   "Hz;', or label steps, in the columns start and end");
        return std::nullopt;
    }

    /// Sorts intervals, and reports the first two that overlap.
    void sort(const std::string& episode, const std::string& predicate,
              std::vector<LabelledSteps>& intervals) {
        std::stable_sort(intervals.begin(), intervals.end(),
                         [](const auto& a, const auto& b) { return a.start < b.start; });
        if (has_too_many()) return;
        for (std::size_t i = 1; i < intervals.size(); ++i) {
            const LabelledSteps& before = intervals[i - 1];
            const LabelledSteps& after = intervals[i];
            if (after.start >= before.end) continue;
            sink_.report(
                data::in_file({Code::contradictory_labels,
                               fmt::format("{} and {} both label {} at step {}", before.place,
                                           after.place, data::in_quotes(predicate), after.start)},
                              episode));
            return;
        }
    }

    const std::vector<const check::Model*>& models_;
    std::vector<std::string> predicates_;
    const std::vector<std::string>& episodes_;
    diag::Sink& sink_;
    std::shared_ptr<LabelSet> result_ = std::make_shared<LabelSet>();
    /// Per episode, its group and the place of the row.
    std::map<std::string, std::pair<std::string, std::string>> groups_;
    bool has_told_of_time_ = false;
};

std::shared_ptr<const LabelSet> LabelSet::read(const LabelSources& sources,
                                               const std::vector<const check::Model*>& models,
                                               const std::vector<std::string>& episodes,
                                               diag::Sink& sink) {
    LabelReader reader(models, episodes, sink);
    for (const TableFile& file : label_files(sources, episodes))
        reader.read_table(file, sources.has_episodes);
    if (sources.by_folder) reader.read_folders();
    return reader.finish();
}

}  // namespace etlc::episodes
