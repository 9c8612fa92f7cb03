#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <tuple>

#include "annotate/write.hpp"
#include "data/files/hash.hpp"
#include "data/text/text.hpp"
#include "driver/commands/commands.hpp"
#include "driver/process/process.hpp"
#include "episodes/admission/admission.hpp"
#include "library/version.hpp"
#include "recordings/datasets/trace.hpp"
#include "recordings/episodes.hpp"
#include "source/text.hpp"

namespace etlc::driver {

namespace {

using diag::Code;
using diag::counted;
using diag::Failure;

/// An episode in the list, with the monitor of which it is worst.
struct Line {
    std::uint64_t index = 0;
    std::string monitor;
    std::string verdict;
    int rank = 2;  ///< 0: violated; 1: unknown; 2: satisfied
    bool is_final = false;
    float robustness = 0;
    std::string why;

    auto order() const { return std::tuple(rank, !is_final, robustness, index); }
};

/// Says which samples decide a verdict: "near fails at steps 0 to 99".
std::string in_words(const report::Scene& scene, const report::Why& why) {
    constexpr std::size_t kMost = 3;
    const check::Model& model = *scene.plan.model;
    std::vector<std::string> parts;
    for (const report::Mark& mark : why.samples) {
        const std::string name = mark.is_predicate
                                     ? model.predicates[scene.predicates[mark.index]].shown()
                                     : model.inputs[scene.plan.inputs[mark.index]].name;
        const std::string steps = mark.first == mark.last
                                      ? fmt::format("step {}", mark.first)
                                      : fmt::format("steps {} to {}", mark.first, mark.last);
        parts.push_back(fmt::format("{} {} at {}", name, mark.holds ? "holds" : "fails", steps));
    }
    const std::size_t shown = std::min(parts.size(), kMost);
    std::string text = fmt::format("{}", fmt::join(parts.begin(), parts.begin() + shown, ", "));
    return text + (parts.size() > shown ? fmt::format(", and {} more", parts.size() - shown) : "");
}

/// Returns the line of an episode, about its worst monitor.
Line line_of(const report::Scene& scene, const report::Tracks& tracks, std::uint64_t index) {
    Line worst;
    for (std::size_t m = 0; m < tracks.outcomes.size(); ++m) {
        const report::Outcome& outcome = tracks.outcomes[m];
        const plan::Monitor& monitor = scene.plan.monitors[m];
        // The last windows of a sliding monitor are cut off by the end of the episode.
        const bool is_open = outcome.status == report::kUndecided ||
                             (monitor.sliding && !outcome.alarm && outcome.status == report::kNo);
        Line line{index, monitor.name, "violated", 0};
        if (is_open || outcome.status == report::kUnknown)
            line = {index, monitor.name, is_open ? "undecided" : "unknown", 1};
        if (outcome.status == report::kYes && !outcome.alarm)
            line = {index, monitor.name, "satisfied", 2};
        line.is_final = outcome.alarm || outcome.final_at;
        line.robustness = outcome.robustness;
        for (const report::Why& why : tracks.reasons)
            if (why.monitor == m && line.rank == 0) line.why = in_words(scene, why);
        if (m == 0 || line.order() < worst.order()) worst = std::move(line);
    }
    return worst;
}

/// Judges episodes, the worst first.
std::optional<std::vector<Line>> lines_of(const Compiled& compiled, const Request& request,
                                          const std::vector<std::string>& paths, diag::Sink& sink) {
    const episodes::ReadOptions reading{request.names, nullptr};
    const report::Scene scene{
        compiled.plan, compiled.plan.predicates, nullptr, nullptr, reading, {}, {}};
    report::TrackReader reader(scene);
    std::vector<Line> lines;
    for (const std::string& path : paths) {
        const auto found = recordings::find_episode(path);
        const std::string from = annotate::samples_of(path, request.annotate.made);
        const auto tracks = reader.score(from);
        if (!found || !tracks) {
            sink.report(recordings::in_trace(found ? tracks.failure() : found.failure(), from));
            return std::nullopt;
        }
        lines.push_back(line_of(scene, *tracks, found->episode->index));
    }
    std::sort(lines.begin(), lines.end(),
              [](const Line& a, const Line& b) { return a.order() < b.order(); });
    return lines;
}

std::string csv_of(const std::vector<Line>& lines) {
    std::string text = "episode,monitor,verdict,robustness,why\n";
    for (const Line& line : lines)
        text += csv_line({std::to_string(line.index), line.monitor,
                          line.verdict + (line.is_final ? " for good" : ""),
                          fmt::format("{:.6g}", line.robustness), line.why});
    return text;
}

/// Returns the calls by which LeRobot drops the violated episodes, or keeps them apart.
std::string calls_of(const std::vector<Line>& lines) {
    std::vector<std::uint64_t> bad;
    std::vector<std::uint64_t> good;
    for (const Line& line : lines) (line.rank == 0 ? bad : good).push_back(line.index);
    std::sort(good.begin(), good.end());
    std::string text =
        fmt::format("violated in {} of {}\n", bad.size(), counted(lines.size(), "episode"));
    if (bad.empty() || good.empty()) return text;  // LeRobot deletes neither none nor all
    return text + fmt::format(
                      "lerobot-edit-dataset --repo_id ID --operation.type delete_episodes "
                      "--operation.episode_indices \"[{0}]\"\n"
                      "lerobot-edit-dataset --repo_id ID --operation.type split "
                      "--operation.splits '{{\"kept\": [{1}], \"rest\": [{0}]}}'\n",
                      fmt::join(bad, ", "), fmt::join(good, ", "));
}

class Annotation {
public:
    Annotation(const source::File& spec, const Compiled& compiled, const Request& request,
               diag::Sink& sink)
        : spec_(spec), compiled_(compiled), request_(request), sink_(sink) {}

    bool execute() {
        const annotate::Wanted& wanted = request_.annotate.wanted;
        if (!check_names({compiled_.model.get()}, request_.names, sink_) || !open()) return false;
        paths_ = recordings::find_episodes(request_.data, {}, sink_);
        if (sink_.has_errors()) return false;
        if (!request_.annotate.list.empty() && !make_list()) return false;
        if (wanted.any() && !write()) return false;
        return !sink_.refused() && print(source::visible_lines(said_), sink_) && list_.commit();
    }

private:
    bool fail(const Failure& failure, const std::string& place) {
        sink_.report(data::in_file(failure, place));
        return false;
    }

    bool open() {
        const std::string& path = request_.data[0];
        const auto named = data::dataset_path(path);
        if (!named || named->first != 0 || named->end != UINT64_MAX)
            return fail({Code::not_annotated, "is no LeRobot data set, expected its folder"}, path);
        const auto set = recordings::Dataset::known(named->folder);
        if (!set) return fail(set.failure(), path);
        set_ = *set;
        const auto refused = annotate::refusal(*set_, request_.annotate.wanted);
        return refused ? fail(*refused, path) : true;
    }

    bool make_list() {
        const auto lines = lines_of(compiled_, request_, paths_, sink_);
        if (!lines) return false;
        said_ += calls_of(*lines);
        const std::string& path = request_.annotate.list;
        return check_outputs({path}, files_read(*compiled_.model, spec_, paths_), sink_) &&
               list_.add(path, csv_of(*lines));
    }

    bool write() {
        const annotate::Wanted& wanted = request_.annotate.wanted;
        const auto judged = annotate::judge(compiled_, request_, wanted, paths_,
                                            request_.annotate.made, request_.names, sink_);
        if (!judged || sink_.refused()) return false;
        if (!say(wanted, *judged)) return false;
        const auto written =
            annotate::write({*set_, request_.output, wanted, compiled_.model->name,
                             data::hash_text(data::xxh64(spec_.text())), library::kVersion},
                            *judged);
        const std::string& to = request_.output.empty() ? set_->folder() : request_.output;
        if (!written)
            return fail(written.failure(),
                        written.failure().code == Code::unwritable_output ? to : set_->folder());
        said_ += fmt::format("{}: {} of rows extended, {} copied, {} linked\n", to,
                             counted(written->extended, "file"), written->copied, written->linked);
        return true;
    }

    bool say(const annotate::Wanted& wanted, const annotate::Judged& judged) {
        if (!wanted.success.empty() && !say_success(wanted, judged)) return false;
        if (!wanted.subtasks.empty()) {
            std::size_t intervals = 0;
            for (const auto& [index, episode] : judged.episodes)
                for (const auto& [row, subtask] : episode.subtasks)
                    intervals += subtask < wanted.subtasks.size() ? 1 : 0;
            said_ += fmt::format("{} in {}\n", counted(intervals, "subtask"),
                                 counted(judged.episodes.size(), "episode"));
        }
        for (std::size_t k = 0; k < judged.phases.size(); ++k)
            said_ += fmt::format("progress {:.3f} at phase {}: {}\n", judged.steps[k + 1], k + 1,
                                 judged.phases[k]);
        return true;
    }

    bool say_success(const annotate::Wanted& wanted, const annotate::Judged& judged) {
        const std::vector<std::uint64_t> open = annotate::undecided(*set_, judged);
        const auto succeeded =
            std::count_if(judged.episodes.begin(), judged.episodes.end(), [](const auto& one) {
                return one.second.outcome == annotate::Episode::Outcome::success;
            });
        if (!open.empty() && !wanted.undecided_is_false) {
            std::vector<std::string> names;
            for (const std::uint64_t index : open) names.push_back(std::to_string(index));
            return fail(
                {Code::not_annotated,
                 fmt::format("'{}' does not decide {}: {}; next.success has no third "
                             "value, and --undecided false writes false",
                             wanted.success, counted(open.size(), "episode"), data::listed(names))},
                "--success");
        }
        said_ += fmt::format("{} of {} succeeded by '{}'", succeeded,
                             counted(set_->episodes().size(), "episode"), wanted.success);
        said_ += open.empty() ? "\n"
                              : fmt::format(", {} undecided, listed in {}\n", open.size(),
                                            annotate::kProvenance);
        return true;
    }

    const source::File& spec_;
    const Compiled& compiled_;
    const Request& request_;
    diag::Sink& sink_;
    std::shared_ptr<recordings::Dataset> set_;
    std::vector<std::string> paths_;
    OutputFiles list_{sink_};
    std::string said_;
};

}  // namespace

bool annotate(const source::File& spec, const Compiled& compiled, const Request& request,
              diag::Sink& sink) {
    return Annotation(spec, compiled, request, sink).execute();
}

}  // namespace etlc::driver
