#include "episodes/labels/labels.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <set>
#include <utility>

#include "data/text/text.hpp"
#include "recordings/datasets/dataset.hpp"
#include "recordings/datasets/subtasks.hpp"
#include "recordings/episodes.hpp"

namespace etlc::episodes {

namespace {

constexpr std::string_view kTruth = "truth.";

/// Adds channels of labels to a trace that lacks them.
class LabelledTrace final : public data::Trace {
public:
    LabelledTrace(std::unique_ptr<data::Trace> trace, const EpisodeLabels& labels)
        : trace_(std::move(trace)), labels_(labels) {}

    /// Takes a channel from the labels.
    void label(std::size_t channel, const std::vector<LabelledSteps>& intervals) {
        cursors_.push_back({channel, intervals.data(), intervals.data() + intervals.size()});
    }

    bool has(std::size_t channel) const override {
        return trace_->has(channel) ||
               std::any_of(cursors_.begin(), cursors_.end(),
                           [&](const Cursor& cursor) { return cursor.channel == channel; });
    }

    std::uint64_t length() const override { return trace_->length(); }

    diag::Result<bool> next(data::Sample& sample) override {
        auto more = trace_->next(sample);
        if (!more) return more;
        if (!*more) return check_end();
        for (Cursor& cursor : cursors_) {
            while (cursor.at != cursor.end && cursor.at->end <= step_) ++cursor.at;
            const bool is_within = cursor.at != cursor.end && cursor.at->start <= step_;
            const Label label = is_within ? cursor.at->label : Label::no;
            sample.present[cursor.channel] = label != Label::unknown;
            sample.values[cursor.channel].assign(1, label == Label::unknown
                                                        ? std::numeric_limits<double>::quiet_NaN()
                                                    : label == Label::yes ? 1
                                                                          : 0);
        }
        ++step_;
        return true;
    }

private:
    struct Cursor {
        std::size_t channel = 0;
        const LabelledSteps* at = nullptr;
        const LabelledSteps* end = nullptr;
    };

    /// Fails where a label is behind the last step.
    diag::Result<bool> check_end() const {
        for (const auto& [predicate, intervals] : labels_) {
            if (intervals.empty()) continue;
            const LabelledSteps& last = intervals.back();
            const bool is_open = last.end == LabelledSteps::kToTheEnd;
            if (step_ == 0 || (is_open ? last.start < step_ : last.end <= step_)) continue;
            return diag::Failure{diag::Code::nothing_to_label,
                                 fmt::format("{} labels {} at step {}, and the last step is {}",
                                             last.place, data::in_quotes(predicate),
                                             is_open ? last.start : last.end - 1, step_ - 1)};
        }
        return false;
    }

    std::unique_ptr<data::Trace> trace_;
    const EpisodeLabels& labels_;
    std::vector<Cursor> cursors_;
    std::uint64_t step_ = 0;
};

diag::Result<std::unique_ptr<data::Trace>> open_unlabelled(
    const std::string& path, const std::vector<data::Channel>& channels, const ReadOptions& options,
    std::shared_ptr<IdentityCache>* identities) {
    const auto renamed = recordings::renamed(channels, options.names);
    if (!options.cache) return recordings::open_trace(path, renamed);
    auto opened = options.cache->open(path, renamed);
    if (!opened) return opened.failure();
    if (identities != nullptr) *identities = opened->identities;
    return std::move(opened->trace);
}

}  // namespace

bool LabelSet::has(const std::string& predicate) const {
    return std::any_of(of_.begin(), of_.end(),
                       [&](const auto& one) { return one.second.contains(predicate); });
}

const EpisodeLabels* LabelSet::of(const std::string& episode) const {
    const auto found = of_.find(episode);
    return found == of_.end() ? nullptr : &found->second;
}

std::string LabelSet::group_of(const std::string& episode) const {
    const auto found = groups_.find(episode);
    return found == groups_.end() ? "" : found->second;
}

Outcome LabelSet::outcome_of(const std::string& episode) const {
    const auto found = outcomes_.find(episode);
    return found == outcomes_.end() ? Outcome{} : found->second;
}

diag::Result<std::unique_ptr<data::Trace>> open_labelled(
    const std::string& path, const std::vector<data::Channel>& channels, const ReadOptions& options,
    std::shared_ptr<IdentityCache>* identities) {
    auto trace = open_unlabelled(path, channels, options, identities);
    const EpisodeLabels* const labels = options.labels ? options.labels->of(path) : nullptr;
    if (!trace || labels == nullptr) return trace;
    auto labelled = std::make_unique<LabelledTrace>(std::move(*trace), *labels);
    for (std::size_t c = 0; c < channels.size(); ++c) {
        const std::string& name = channels[c].name;
        if (!name.starts_with(kTruth)) continue;
        const auto found = labels->find(name.substr(kTruth.size()));
        if (found == labels->end()) continue;
        if (labelled->has(c))
            return diag::Failure{
                diag::Code::contradictory_labels,
                fmt::format("has an array {}, and {} labels {} too: remove one of them",
                            data::in_quotes(recordings::name_in_file(name, options.names)),
                            found->second.front().place, data::in_quotes(found->first))};
        labelled->label(c, found->second);
    }
    return std::unique_ptr<data::Trace>(std::move(labelled));
}

void open_near_changes(std::vector<Label>& labels, std::uint32_t within) {
    const std::vector<Label> exact = labels;
    const std::size_t none = exact.size();
    std::size_t last = none;  // the last known label
    for (std::size_t i = 0; i < exact.size(); ++i) {
        if (exact[i] == Label::unknown) continue;
        if (last != none && exact[last] != exact[i]) {
            const std::size_t from = last + 1 - std::min<std::size_t>(within, last + 1);
            const std::size_t end = i + std::min<std::size_t>(within, exact.size() - i);
            std::fill(labels.begin() + static_cast<std::ptrdiff_t>(from),
                      labels.begin() + static_cast<std::ptrdiff_t>(end), Label::unknown);
        }
        last = i;
    }
}

std::vector<std::string> groups_of(const std::vector<std::string>& episodes,
                                   const ReadOptions& options) {
    std::vector<std::string> groups(episodes.size());
    for (std::size_t e = 0; e < episodes.size() && options.labels; ++e)
        groups[e] = options.labels->group_of(episodes[e]);
    return groups;
}

// ---- reading the tables -------------------------------------------------------------------------
// Looks up the episodes and predicates of tables of labels, and compares the labels with each
// other.

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
        const std::string succeeds(name_of(Outcome::Kind::success));
        const std::string fails(name_of(Outcome::Kind::failure));
        if (labelled.empty() && !around.contains(succeeds) && !around.contains(fails)) {
            std::vector<std::string> words(known.begin(), known.end());
            words.insert(words.end(), {succeeds, fails});
            sink_.report(data::in_file(
                {Code::nothing_to_label,
                 fmt::format("the episodes lie in {}, and none of these is a predicate or an "
                             "outcome; there are {}",
                             data::listed({around.begin(), around.end()}), data::listed(words))},
                "--label-by folder"));
            return;
        }
        for (std::size_t e = 0; e < episodes_.size(); ++e) {
            const auto is_in = [&](const std::string& folder) {
                return std::find(folders[e].begin(), folders[e].end(), folder) != folders[e].end();
            };
            if (is_in(succeeds) != is_in(fails))
                add_outcome(episodes_[e],
                            {is_in(fails) ? Outcome::Kind::failure : Outcome::Kind::success},
                            "--label-by folder", 0);
            for (const std::string& predicate : labelled) {
                result_->of_[episodes_[e]][predicate].push_back(
                    {0, LabelledSteps::kToTheEnd, is_in(predicate) ? Label::yes : Label::no,
                     "--label-by folder"});
            }
        }
    }

    /// Takes the outcomes that episodes say of themselves.
    void read_outcomes() {
        for (const std::string& episode : episodes_) {
            const auto succeeded = recordings::recorded_success(episode);
            if (!succeeded) {
                sink_.report(recordings::in_trace(succeeded.failure(), episode));
                return;
            }
            if (!*succeeded) continue;
            add_outcome(episode, {**succeeded ? Outcome::Kind::success : Outcome::Kind::failure},
                        "--label-by outcome", 0);
        }
        if (!result_->has_outcomes())
            sink_.report(data::in_file({Code::nothing_to_label,
                                        "no episode has 'next.success', which is true at some step "
                                        "of a success, nor an attribute 'success' of an .h5 group"},
                                       "--label-by outcome"));
    }

    /// A predicate holds in the rows whose subtask has its name, and in no other row of an episode
    /// that has subtasks.
    void read_subtasks() {
        std::map<std::string, recordings::Subtasks> subtasks;
        std::set<std::string> names;
        for (const std::string& episode : episodes_) {
            if (!data::dataset_path(episode)) continue;
            auto found = recordings::read_subtasks(episode);
            if (!found) {
                sink_.report(recordings::in_trace(found.failure(), episode));
                return;
            }
            if (found->source.empty()) continue;
            names.insert(found->names.begin(), found->names.end());
            subtasks.emplace(episode, std::move(*found));
        }
        std::set<std::string> labelled;
        for (const std::string& predicate : predicates_)
            if (names.contains(predicate)) labelled.insert(predicate);
        if (labelled.empty()) {
            sink_.report(data::in_file(
                {Code::nothing_to_label,
                 names.empty()
                     ? "no episode has subtasks: expected a LeRobot data set with "
                       "language_persistent, subtask_index or sparse_subtask_names"
                     : fmt::format("the subtasks are {}, and none of these is a predicate; there "
                                   "are {}",
                                   data::listed({names.begin(), names.end()}),
                                   data::listed(predicates_))},
                "--label-by subtask"));
            return;
        }
        std::size_t unknown = 0;
        for (const auto& [episode, of] : subtasks) {
            unknown += std::count(of.of_row.begin(), of.of_row.end(), of.kUnknown);
            for (const std::string& predicate : labelled) label_rows(episode, predicate, of);
        }
        tell_unmatched(names, labelled, unknown);
    }

    /// Warns of a text that truths compare with subtasks, and that no episode has.
    void look_for_texts() {
        for (const check::Model* model : models_)
            for (const check::Input& input : model->inputs) {
                const auto asked = data::subtask_name(input.name);
                if (!asked) continue;
                std::set<std::string> names;
                for (const std::string& episode : episodes_) {
                    if (!data::dataset_path(episode)) continue;
                    const auto found = recordings::read_subtasks(episode, asked->word);
                    if (!found) break;  // whoever reads the episode says why
                    names.insert(found->names.begin(), found->names.end());
                    if (names.contains(std::string(asked->text))) break;
                }
                if (names.empty() || names.contains(std::string(asked->text))) continue;
                const std::vector<std::string> all(names.begin(), names.end());
                const std::string meant = data::suggestion(asked->text, all);
                sink_.report(data::in_file(
                    {Code::subtasks_unmatched,
                     "no episode shows this subtask" +
                         (meant.empty() ? "; there are " + data::listed(all) : meant)},
                    input.name));
            }
    }

    /// Returns the labels if none is in error.
    std::shared_ptr<const LabelSet> finish() {
        for (auto& [episode, labels] : result_->of_)
            for (auto& [predicate, intervals] : labels) sort(episode, predicate, intervals);
        const bool is_empty =
            result_->tables_.empty() && result_->of_.empty() && !result_->has_outcomes();
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

    void label_rows(const std::string& episode, const std::string& predicate,
                    const recordings::Subtasks& of) {
        std::vector<LabelledSteps>& intervals = result_->of_[episode][predicate];
        const std::string place = fmt::format("{}: {}", episode, of.source);
        for (std::uint64_t row = 0, end = 0; row < of.of_row.size(); row = end) {
            const auto shows = of.shows(row, predicate);
            while (end < of.of_row.size() && of.shows(end, predicate) == shows) ++end;
            if (shows != false)
                intervals.push_back({row, end, shows ? Label::yes : Label::unknown, place});
        }
        if (intervals.empty()) intervals.push_back({0, LabelledSteps::kToTheEnd, Label::no, place});
    }

    /// Warns of what `--label-by subtask` leaves out.
    void tell_unmatched(std::set<std::string> names, const std::set<std::string>& labelled,
                        std::size_t unknown) {
        std::set<std::string> without;
        for (const check::Model* model : models_)
            for (check::Index p = 0; p < model->predicates.size(); ++p) {
                const std::string& name = model->predicates[p].name;
                const bool has_truth =
                    std::any_of(model->truths.begin(), model->truths.end(),
                                [&](const check::Truth& truth) { return truth.predicate == p; });
                if (!name.empty() && !has_truth && !result_->has(name)) without.insert(name);
            }
        std::vector<std::string> parts;
        for (const std::string& name : labelled) names.erase(name);
        if (!names.empty())
            parts.push_back(fmt::format("no predicate is named after the subtasks {}",
                                        data::listed({names.begin(), names.end()})));
        if (!without.empty())
            parts.push_back(fmt::format("no subtask is named after the predicates {}",
                                        data::listed({without.begin(), without.end()})));
        if (unknown > 0)
            parts.push_back(
                fmt::format("a negative subtask_index, or none, leaves {} without label",
                            diag::counted(unknown, "row")));
        if (!parts.empty())
            sink_.report(
                data::in_file({Code::subtasks_unmatched, fmt::format("{}", fmt::join(parts, "; "))},
                              "--label-by subtask"));
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
        if (row.outcome != Outcome::Kind::none) {
            Outcome outcome{row.outcome};
            if (row.start > 0) {
                const auto steps = steps_of(row, table, path, episode);
                if (!steps) return;
                outcome.failed_at = steps->first;
            }
            return add_outcome(episode, outcome, path, row.line);
        }
        if (row.predicate.empty()) return;
        const auto steps = steps_of(row, table, path, episode);
        if (steps)
            result_->of_[episode][row.predicate].push_back(
                {steps->first, steps->second, row.label, place});
    }

    /// Reports two outcomes of an episode that differ. `line`: 0 for none.
    void add_outcome(const std::string& episode, const Outcome& outcome, const std::string& path,
                     std::uint32_t line) {
        const auto [before, is_new] = outcomes_.emplace(
            episode, std::pair{outcome, line == 0 ? path : fmt::format("{}:{}", path, line)});
        result_->outcomes_[episode] = outcome;
        if (is_new || before->second.first == outcome) return;
        const auto said = [](const Outcome& one) {
            return fmt::format("{}{}", name_of(one.kind),
                               one.failed_at > 0 ? fmt::format(" at step {}", one.failed_at) : "");
        };
        report(Code::contradictory_labels, path, line,
               fmt::format("calls {} a {}", data::in_quotes(episode), said(outcome)))
            .note(
                fmt::format("{} calls it a {}", before->second.second, said(before->second.first)));
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
    std::map<std::string, std::pair<Outcome, std::string>> outcomes_;  ///< likewise
    bool has_told_of_time_ = false;
};

std::shared_ptr<const LabelSet> LabelSet::read(const LabelSources& sources,
                                               const std::vector<const check::Model*>& models,
                                               const std::vector<std::string>& episodes,
                                               diag::Sink& sink) {
    LabelReader reader(models, episodes, sink);
    for (const TableFile& file : label_files(sources, episodes))
        reader.read_table(file, sources.has_episodes);
    if (sources.by == LabelBy::folder) reader.read_folders();
    if (sources.by == LabelBy::outcome && sources.has_episodes) reader.read_outcomes();
    if (sources.by == LabelBy::subtask && sources.has_episodes) reader.read_subtasks();
    if (sources.has_episodes) reader.look_for_texts();
    return reader.finish();
}

}  // namespace etlc::episodes
