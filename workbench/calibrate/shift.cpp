#include "calibrate/shift.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <set>

#include "calibrate/bounds.hpp"
#include "calibrate/durations.hpp"
#include "check/guarantees/calibrated.hpp"
#include "check/guarantees/conformal.hpp"
#include "check/guarantees/guarantees.hpp"
#include "check/guarantees/provenance.hpp"
#include "check/numbers/decimal.hpp"
#include "compile.hpp"
#include "episodes/admission/admission.hpp"
#include "episodes/folds.hpp"
#include "episodes/parallel.hpp"

namespace etlc::calibrate {

namespace {

using check::Against;
using check::round_down;
using check::round_up;
using diag::Code;
using diag::counted;

/// Returns the greatest low end of the robustness of the predicate in any build, and its least high
/// end.
plan::Value spread(const check::Model& model, Index predicate, const execute::Evaluator& measured,
                   const PastIntervals& pasts) {
    const Interval delta = *interval_of(model, predicate, measured, pasts);
    const check::Predicate& p = model.predicates[predicate];
    const float true_within = p.threshold.low();
    const float false_beyond = p.threshold.value;
    const float low =
        p.upper_bound() ? true_within - round_down(delta.low) : round_up(delta.high) - true_within;
    const float high = p.upper_bound() ? false_beyond - round_up(delta.high)
                                       : round_down(delta.low) - false_beyond;
    return {etlmon::key_of(low), etlmon::key_of(high)};
}

/// Returns the index of the negated monitor of each calibrated one that the scores need; kNone for
/// the others. It is added to the model.
std::vector<Index> add_negations(check::Model& model, const check::Model& calibrated,
                                 const std::vector<Index>& monitors) {
    std::vector<Index> negations;
    for (const Index m : monitors) {
        negations.push_back(check::kNone);
        if (!is_against(*calibrated.monitors[m].calibration, true)) continue;
        check::Formula negation;
        negation.kind = check::Formula::Kind::negation;
        negation.operands = {model.monitors[m].formula};
        check::Monitor negated = model.monitors[m];
        negated.formula = static_cast<Index>(model.formulas.size());
        negations.back() = static_cast<Index>(model.monitors.size());
        model.formulas.push_back(std::move(negation));
        model.monitors.push_back(std::move(negated));
    }
    return negations;
}

/// Plans of the unshifted model and of its ground truth.
struct MonitorPlans {
    const plan::Plan& monitors;
    const plan::Plan& truths;
    const episodes::GroundTruth& ground_truth;
    const std::vector<Index>& negations;       ///< per calibrated monitor, the one that negates it
    const std::vector<std::uint32_t>& within;  ///< per predicate, as in episodes::Wanted
};

/// Scores the calibrated monitors in one episode after the other, on one thread. The low ends of
/// rho and of its negation are as low as those of a verdict where samples are missing or between
/// two thresholds, and as high as in any build otherwise. The arguments must outlive it.
class MonitorScorer {
public:
    MonitorScorer(const check::Model& model, const MonitorPlans& plans,
                  const episodes::Leaks& leaks, const std::vector<Index>& monitors,
                  const Watched& watched, const episodes::ReadOptions& reading)
        : model_(model),
          monitors_(monitors),
          negations_(plans.negations),
          watched_(watched),
          reading_(reading),
          highest_(plans.monitors),
          measured_(plans.monitors),
          pasts_(model, plans.monitors),
          truths_(plans.truths, &plans.ground_truth),
          wanted_(episodes::wanted(model, {&plans.monitors, &plans.truths},
                                   episodes::labelled_predicates(plans.ground_truth), leaks)),
          divided_(wanted_),
          values_(model.predicates.size()) {
        for (const Index monitor : timed_monitors(model)) durations_.emplace_back(model, monitor);
        for (const Index monitor : monitors)
            has_normal_ |= is_normal(*model.monitors[monitor].calibration);
        wanted_.within = divided_.within = plans.within;
        divided_.predicates.clear();
        std::set_union(wanted_.predicates.begin(), wanted_.predicates.end(),
                       watched.dividing.begin(), watched.dividing.end(),
                       std::back_inserter(divided_.predicates));
        // The low end of a verdict reads the low end of a literal, and the high end of a negated
        // one; the range of a missing sample stays.
        execute::Evaluator& highest = highest_.evaluator();
        highest.after_pasts([&] { pasts_.step(highest); });
        highest.replace_predicate_values([&](Index p) {
            const plan::Value value = spread(model_, p, highest, pasts_);
            values_[p] = {value.low, value.high};
            return value;
        });
    }
    MonitorScorer(const MonitorScorer&) = delete;
    MonitorScorer& operator=(const MonitorScorer&) = delete;

    /// Failures do not name the path.
    diag::Result<MonitorEpisode> score(const std::string& path) {
        auto divided = score(path, divided_);
        if (divided || divided_.predicates.size() == wanted_.predicates.size()) return divided;
        return score(path, wanted_);
    }

private:
    diag::Result<MonitorEpisode> score(const std::string& path, const episodes::Wanted& wanted) {
        auto recording = episodes::Recording::open(wanted, path, reading_);
        if (!recording) return recording.failure();
        std::vector<Scores> scores(monitors_.size());
        std::string track;
        const bool is_divided = wanted.predicates.size() == divided_.predicates.size();
        pasts_.reset();
        for (DurationScorer& duration : durations_) duration.reset();
        const auto rest = [&] {
            note(scores);
            return true;
        };
        const auto frame = [&] {
            add_step(watched_, highest_.evaluator(), *recording, is_divided, track);
            add_to_durations(*recording);
            return rest();
        };
        std::vector<episodes::Follower*> followers{&truths_, &highest_};
        if (has_normal_) followers.push_back(&measured_);
        const auto done = episodes::replay(*recording, followers, frame, rest);
        if (!done) return done.failure();
        MonitorEpisode result{recording->recorded(), std::move(scores), {}, {},
                              std::move(track),      is_divided};
        for (DurationScorer& duration : durations_) {
            const auto found = duration.score();
            if (!found) return found.failure();
            result.durations.push_back(*found);
        }
        for (const Index predicate : wanted_.predicates)
            if (recording->from_array(predicate)) result.from_arrays.push_back(predicate);
        return result;
    }

    void add_to_durations(const episodes::Frames& frames) {
        for (DurationScorer& duration : durations_) duration.add(values_, frames);
        std::fill(values_.begin(), values_.end(), std::nullopt);
    }

    void note(std::vector<Scores>& scores) const {
        for (std::size_t i = 0; i < monitors_.size(); ++i) {
            const Index monitor = monitors_[i];
            if (!truths_.reports(monitor)) continue;
            const check::Threshold& shift = *model_.monitors[monitor].calibration;
            if (is_normal(shift)) {
                ++scores[i].positives.frames;
                scores[i].positives.add_normal(
                    static_cast<double>(highest_.verdict(negations_[i]).lower),
                    -static_cast<double>(measured_.verdict(monitor).upper));
                continue;
            }
            const etlmon::Verdict& truth = truths_.verdict(monitor);
            const bool satisfied = truth.satisfied();
            if (truth.unknown()) {
                ++scores[i].unlabelled;
                continue;
            }
            SideScores& side = scores[i].side(satisfied);
            ++side.frames;
            if (!is_against(shift, satisfied)) continue;
            const double reach = highest_.verdict(satisfied ? negations_[i] : monitor).robustness;
            if (reach > -std::numeric_limits<double>::infinity()) side.add(reach, keeps_all(shift));
        }
    }

    const check::Model& model_;
    const std::vector<Index>& monitors_;
    const std::vector<Index>& negations_;
    const Watched& watched_;
    const episodes::ReadOptions& reading_;
    episodes::Follower highest_;   ///< the highest low ends in any build
    episodes::Follower measured_;  ///< this build
    PastIntervals pasts_;
    episodes::Follower truths_;
    episodes::Wanted wanted_;
    episodes::Wanted divided_;  ///< the same with the labels that divide episodes
    std::vector<DurationScorer> durations_;
    std::vector<std::optional<Ends>> values_;  ///< of this step, per measured predicate
    bool has_normal_ = false;                  ///< some monitor learns from normal episodes
};

/// Adds what the entry was computed from.
thresholds::Entry complete(thresholds::Entry entry, const check::Model& model,
                           const check::Monitor& monitor, const episodes::Identities& episodes,
                           const check::Labelling& labelling) {
    entry.reads = check::reads(model, monitor, labelling);
    episodes.for_each([&](std::size_t, const episodes::Recorded& episode) {
        entry.episodes.push_back(episodes::hash_of(episode));
    });
    return entry;
}

std::string monitor_report(const check::Model& model, const check::Monitor& monitor,
                           const Subject& of, const Sides& sides, const episodes::Groups& groups) {
    const check::Threshold& shift = *monitor.calibration;
    const Aim aim = aims_of(of.predicate).front();
    std::string text =
        fmt::format("\n{}: rho of {}", monitor.name, check::shown(model, monitor.formula));
    const std::vector<check::Guarantee> guarantees = check::guarantees(model, monitor);
    if (sides.size() == 1 && shift.bounds_episodes()) {
        const std::string which = is_normal(shift)
                                      ? ""
                                      : fmt::format(" whose ground truth is {} at some step",
                                                    aim.of_positives ? "satisfied" : "violated");
        text += fmt::format(
            " less {:.9g}\n"
            "    {}, alpha = {}: {}{}\n"
            "    {}; given these {}, with probability >= 1 - {:.3f} to 1 - {:.3f} (5 % and 95 % "
            "quantiles, without ties)\n",
            shift.value, check::method_name(shift.origin), shift.alpha,
            describe_place(sides[0], aim.above, of.noun()), which, check::text(guarantees[0]),
            groups.are_named() ? counted(shift.n, "group") : std::to_string(shift.n),
            1 - check::coverage_quantile(shift.n, shift.k, 0.05),
            1 - check::coverage_quantile(shift.n, shift.k, 0.95));
    } else {
        text += fmt::format("\n    {}\n    {}\n", shift.text, check::of_shift(shift));
        for (const check::Guarantee& guarantee : guarantees)
            text += fmt::format("    {}\n", check::text(guarantee));
    }
    if (is_normal(shift)) return text + describe_failures(of.evidence.failures);
    text += describe_sides(of, sides);
    if (of.evidence.unlabelled > 0)
        text +=
            fmt::format("    {} skipped, where a missing label{} leaves the ground truth open\n",
                        counted(of.evidence.unlabelled, "step"),
                        shift.within > 0 ? " or one near a change" : "");
    return text;
}

/// Returns the steps around a change at which the labels of each predicate are unknown. Reports
/// monitors that read the same labels and differ in them.
std::vector<std::uint32_t> within_of(const check::Model& model, const std::vector<Index>& monitors,
                                     const std::vector<Index>& labelled, diag::Sink& sink) {
    std::vector<std::uint32_t> within(model.predicates.size());
    std::map<Index, const check::Monitor*> readers;
    for (const Index m : monitors) {
        const check::Monitor& monitor = model.monitors[m];
        if (is_normal(*monitor.calibration)) continue;
        for (const Index p : check::predicates_of(model, monitor)) {
            if (!std::binary_search(labelled.begin(), labelled.end(), p)) continue;
            within[p] = monitor.calibration->within;
            const check::Monitor& other = *readers.emplace(p, &monitor).first->second;
            if (other.calibration->within == within[p]) continue;
            sink.report(Code::calibration_argument, monitor.calibration->span,
                        fmt::format("'{}' and '{}' are calibrated with the labels of '{}' and "
                                    "differ in 'within'; expected the same",
                                    other.name, monitor.name, model.predicates[p].name));
            break;
        }
    }
    return within;
}

/// Returns the predicates that are not their own truth or have labels in the first episode.
std::vector<Index> find_labelled(const check::Model& model, const std::vector<Index>& monitors,
                                 const std::vector<Index>& in_first) {
    std::set<Index> found;
    for (const Index monitor : monitors) {
        if (is_normal(*model.monitors[monitor].calibration)) continue;
        for (const Index predicate : check::predicates_of(model, model.monitors[monitor]))
            if (!check::is_own_truth(model, predicate) ||
                std::binary_search(in_first.begin(), in_first.end(), predicate))
                found.insert(predicate);
    }
    return {found.begin(), found.end()};
}

std::vector<Index> shifted_monitors(const check::Model& model) {
    std::vector<Index> found = calibrated_monitors(model);
    std::erase_if(found, [&](Index m) { return !model.monitors[m].calibration; });
    return found;
}

/// Returns the predicates whose targets no frame may equal.
std::vector<Index> scored_predicates(const check::Model& model, std::vector<Index> labelled) {
    std::set<Index> found(labelled.begin(), labelled.end());
    for (const Index m : timed_monitors(model))
        for (const Index p : check::predicates_of(model, model.monitors[m].formula))
            found.insert(p);
    return {found.begin(), found.end()};
}

}  // namespace

std::vector<Index> calibrated_monitors(const check::Model& model) {
    std::vector<Index> found;
    for (Index m = 0; m < model.monitors.size(); ++m)
        if (model.monitors[m].calibration || model.monitors[m].duration) found.push_back(m);
    return found;
}

check::Model unshifted(check::Model model) {
    for (check::Monitor& monitor : model.monitors) monitor.calibration.reset();
    model.drifts.clear();  // their scores are those of the shifted ones
    return model;
}

std::optional<Calibration> calibrate_monitors(const check::Model& model, thresholds::File before,
                                              const Request& request, diag::Sink& sink) {
    const std::vector<Index> monitors = shifted_monitors(model);
    const std::vector<Index> timed = timed_monitors(model);
    if (!episodes::can_be_dealt(request.episodes, request.reading, request.folds, model, sink))
        return std::nullopt;
    const auto in_first = episodes::labelled_in_first(model, request, sink);
    if (!in_first) return std::nullopt;
    const std::vector<Index> labelled = find_labelled(model, monitors, *in_first);
    check::Model plain = unshifted(model);
    const episodes::GroundTruth truth = episodes::ground_truth(plain, labelled);
    const std::vector<std::uint32_t> within = within_of(model, monitors, labelled, sink);
    const std::vector<Index> negations = add_negations(plain, model, monitors);
    const auto compiled = compile(std::move(plain), {}, sink);
    // The truth does not depend on rho.
    const auto truths = compile(truth.model, {{}, check::Values::boolean}, sink);
    if (!compiled || !truths || sink.has_errors()) return std::nullopt;
    const MonitorPlans plans{compiled->plan, truths->plan, truth, negations, within};

    const episodes::Leaks leaks(model, scored_predicates(model, labelled));
    episodes::Identities recorded;
    episodes::Groups groups;
    std::vector<Evidence> evidence(monitors.size());
    std::vector<Times> times(timed.size());
    const std::vector<Guaranteed> guarantees = guaranteed(model, true);
    const Watched watched = watched_by(model, guarantees, labelled, *in_first);
    Tracks tracks;
    bool is_divided = true;
    std::uint64_t frames = 0;
    check::Labelling labelling;
    const bool all_normal = std::all_of(monitors.begin(), monitors.end(), [&](Index m) {
        return is_normal(*model.monitors[m].calibration);
    });
    const bool all_scored = episodes::over_shared_episodes<MonitorEpisode>(
        request.episodes, request, sink,
        [&] {
            return std::make_unique<MonitorScorer>(model, plans, leaks, monitors, watched,
                                                   request.reading);
        },
        [&](std::size_t, MonitorEpisode episode) {
            if (all_normal && !episode.outcome.is_demonstration()) {
                for (Evidence& of : evidence) ++of.failures;
                for (Times& of : times) ++of.failures;
                return;
            }
            recorded.add(episode);
            frames += episode.frames;
            ++labelling.episodes;
            for (const Index predicate : episode.from_arrays) ++labelling.from_arrays[predicate];
            const std::uint32_t group = groups.add(episode.group);
            for (std::size_t i = 0; i < monitors.size(); ++i)
                if (leaves_out(*model.monitors[monitors[i]].calibration, episode))
                    ++evidence[i].failures;
                else
                    evidence[i].add(episode.scores[i], group);
            for (std::size_t i = 0; i < timed.size(); ++i)
                if (episode.outcome.is_demonstration())
                    times[i].add(episode.durations[i], group);
                else
                    ++times[i].failures;
            tracks.add(episode.track);
            is_divided &= episode.is_divided;
        });
    if (!all_scored) return std::nullopt;
    episodes::warn_of_unmarked(recorded, sink);
    const thresholds::Allowance allowance =
        episodes::admit(model, recorded, before, request.fitted, request.allow_overlap, sink);
    if (sink.has_errors()) return std::nullopt;

    Calibration result{std::move(before), {}};
    result.file.spec = model.name;
    result.file.etlc = request.version;
    episodes::record(recorded, allowance, result.file);
    check::Model shifted = model;
    std::vector<std::string> reports;
    std::vector<LeftOut> out;
    std::vector<check::Predicate> predicates;
    for (const Index m : monitors) predicates.push_back(over_robustness(model.monitors[m]));
    std::vector<Subject> subjects;
    for (std::size_t i = 0; i < monitors.size(); ++i) {
        const check::Monitor& monitor = model.monitors[monitors[i]];
        subjects.push_back({predicates[i], evidence[i], true, groups.are_named()});
        const auto sides = fit_all(model, subjects.back(), sink);
        if (!sides) continue;
        warn_of_large_alpha(predicates[i], sink);
        thresholds::Entry& entry = result.file.monitors[monitor.name];
        entry = complete(entry_of(*monitor.calibration, *sides, {}), model, monitor, recorded,
                         labelling);
        if (is_normal(*monitor.calibration)) entry.measured = measured_scores(evidence[i], false);
        check::Threshold& shift = *shifted.monitors[monitors[i]].calibration;
        set(shift, predicates[i], *sides);
        shift.by_group = groups.are_named();
        reports.push_back(monitor_report(shifted, shifted.monitors[monitors[i]], subjects.back(),
                                         *sides, groups));
        if (!is_normal(shift))
            out.push_back(left_out(predicates[i], evidence[i], recorded, groups));
    }
    std::string of_durations;
    for (std::size_t i = 0; i < timed.size(); ++i) {
        check::Monitor& monitor = shifted.monitors[timed[i]];
        times[i].by_group = groups.are_named();
        auto entry = fit_duration(monitor, times[i], sink);
        if (!entry) continue;
        set_calibrated(shifted, monitor, *entry, groups.are_named());
        of_durations += describe_duration(shifted, monitor, *entry);
        of_durations += describe_failures(times[i].failures);
        result.file.monitors[monitor.name] =
            complete(std::move(*entry), model, model.monitors[timed[i]], recorded, labelling);
    }
    if (sink.has_errors()) return std::nullopt;
    const auto others = other_errors_of_shifts(shifted, guarantees, out,
                                               {tracks, watched, groups, true, is_divided});
    result.report = fmt::format("{}{}, {}\n", counted(groups.episodes(), "episode"),
                                in_groups(groups), counted(frames, "frame"));
    for (std::size_t i = 0, next = 0; i < monitors.size(); ++i) {
        result.report += reports[i];
        if (is_normal(*model.monitors[monitors[i]].calibration)) continue;
        result.report += describe(others[next], guarantees[next], "    ");
        warn_of_empty(model, guarantees[next], others[next], sink);
        ++next;
    }
    if (!guarantees.empty())
        result.report += "\n" + note_on_other_errors(groups.are_named(), has_cost(guarantees));
    result.report += of_durations;
    if (!monitors.empty())
        result.report += report_of_folds(subjects, recorded, groups, request.folds);
    thresholds::drop_unused_recordings(result.file);
    for (const thresholds::Allowance& used : result.file.allowances)
        result.report += fmt::format("\n{}\n", thresholds::text(used));
    result.report += episodes::remark_on(allowance);
    return result;
}

}  // namespace etlc::calibrate
