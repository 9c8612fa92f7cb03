#include "calibrate/shift.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <set>

#include "calibrate/bounds.hpp"
#include "check/guarantees/calibrated.hpp"
#include "check/guarantees/conformal.hpp"
#include "check/guarantees/guarantees.hpp"
#include "check/guarantees/provenance.hpp"
#include "check/numbers/decimal.hpp"
#include "compile.hpp"
#include "data/files/file.hpp"
#include "episodes/admission/admission.hpp"
#include "episodes/folds.hpp"
#include "episodes/parallel.hpp"
#include "episodes/recording.hpp"

namespace etlc::calibrate {

namespace {

using check::Against;
using check::round_down;
using check::round_up;
using diag::Code;
using diag::counted;

bool against_alarms(const check::Monitor& monitor) {
    return monitor.calibration->against == Against::missed_alarm;
}

/// Returns the ground truth's verdict at the steps that give a score.
std::string_view truth_word(const check::Monitor& monitor) {
    return against_alarms(monitor) ? "violated" : "satisfied";
}

/// Returns the least and the greatest robustness of the predicate in any build.
plan::Value spread(const check::Model& model, Index predicate, const execute::Evaluator& measured,
                   const PastIntervals& pasts) {
    const Interval delta = *interval_of(model, predicate, measured, pasts);
    const check::Predicate& p = model.predicates[predicate];
    const float epsilon = p.threshold.value;
    const float low =
        p.upper_bound() ? epsilon - round_up(delta.high) : round_down(delta.low) - epsilon;
    const float high =
        p.upper_bound() ? epsilon - round_down(delta.low) : round_up(delta.high) - epsilon;
    return {etlmon::key_of(low), etlmon::key_of(high)};
}

/// Scores the calibrated monitors in one episode after the other, on one thread. Rho is as
/// pessimistic as that of a verdict where samples are missing, and as high (low) as in any build
/// otherwise. The arguments must outlive it.
class MonitorScorer {
public:
    MonitorScorer(const check::Model& model, const MonitorPlans& plans,
                  const episodes::Leaks& leaks, const std::vector<Index>& monitors,
                  const Watched& watched, const episodes::ReadOptions& reading);
    MonitorScorer(const MonitorScorer&) = delete;
    MonitorScorer& operator=(const MonitorScorer&) = delete;

    /// Failures do not name the path.
    diag::Result<MonitorEpisode> score(const std::string& path);

private:
    diag::Result<MonitorEpisode> score(const std::string& path, const episodes::Wanted& wanted);
    void note(std::vector<MonitorScore>& scores) const;

    const check::Model& model_;
    const std::vector<Index>& monitors_;
    const Watched& watched_;
    const episodes::ReadOptions& reading_;
    episodes::Follower highest_;  ///< the highest rho in any build
    episodes::Follower lowest_;
    PastIntervals pasts_of_highest_;  ///< both measure the same, one after the other
    PastIntervals pasts_of_lowest_;
    episodes::Follower truths_;
    episodes::Wanted wanted_;
    episodes::Wanted divided_;  ///< the same with the labels that divide episodes
};

MonitorScorer::MonitorScorer(const check::Model& model, const MonitorPlans& plans,
                             const episodes::Leaks& leaks, const std::vector<Index>& monitors,
                             const Watched& watched, const episodes::ReadOptions& reading)
    : model_(model),
      monitors_(monitors),
      watched_(watched),
      reading_(reading),
      highest_(plans.monitors),
      lowest_(plans.monitors),
      pasts_of_highest_(model, plans.monitors),
      pasts_of_lowest_(model, plans.monitors),
      truths_(plans.truths, &plans.ground_truth),
      wanted_(episodes::wanted(model, {&plans.monitors, &plans.truths},
                               episodes::labelled_predicates(plans.ground_truth), leaks)),
      divided_(wanted_) {
    divided_.predicates.clear();
    std::set_union(wanted_.predicates.begin(), wanted_.predicates.end(), watched.dividing.begin(),
                   watched.dividing.end(), std::back_inserter(divided_.predicates));
    execute::Evaluator& lowest = lowest_.evaluator();
    lowest.after_pasts([&] { pasts_of_lowest_.step(lowest); });
    lowest.replace_predicate_values(
        [&](Index p) { return spread(model_, p, lowest, pasts_of_lowest_); });
    // A verdict reads the low end: the first end for a literal, the second for a negated one. With
    // the ends exchanged it reads the highest in any build, and the range of a missing sample
    // stays.
    execute::Evaluator& highest = highest_.evaluator();
    highest.after_pasts([&] { pasts_of_highest_.step(highest); });
    highest.replace_predicate_values([&](Index p) {
        const plan::Value value = spread(model_, p, highest, pasts_of_highest_);
        return plan::Value{value.high, value.low};
    });
}

diag::Result<MonitorEpisode> MonitorScorer::score(const std::string& path) {
    auto divided = score(path, divided_);
    if (divided || divided_.predicates.size() == wanted_.predicates.size()) return divided;
    return score(path, wanted_);
}

diag::Result<MonitorEpisode> MonitorScorer::score(const std::string& path,
                                                  const episodes::Wanted& wanted) {
    auto recording = episodes::Recording::open(wanted, path, reading_);
    if (!recording) return recording.failure();
    std::vector<MonitorScore> scores(monitors_.size());
    std::string track;
    const bool is_divided = wanted.predicates.size() == divided_.predicates.size();
    pasts_of_highest_.reset();
    pasts_of_lowest_.reset();
    const auto rest = [&] {
        note(scores);
        return true;
    };
    const auto frame = [&] {
        add_step(watched_, highest_.evaluator(), *recording, is_divided, track);
        return rest();
    };
    const auto done = episodes::replay(*recording, {&truths_, &highest_, &lowest_}, frame, rest);
    if (!done) return done.failure();
    MonitorEpisode result{
        recording->recorded(), std::move(scores), {}, std::move(track), is_divided};
    for (const Index predicate : wanted_.predicates)
        if (recording->from_array(predicate)) result.from_arrays.push_back(predicate);
    return result;
}

void MonitorScorer::note(std::vector<MonitorScore>& scores) const {
    for (std::size_t i = 0; i < monitors_.size(); ++i) {
        const Index monitor = monitors_[i];
        if (!truths_.reports(monitor)) continue;
        const etlmon::Verdict& truth = truths_.verdict(monitor);
        MonitorScore& score = scores[i];
        if (truth.unknown()) ++score.unknown;
        const bool alarms =
            model_.monitors[monitor].calibration->against == check::Against::missed_alarm;
        if (alarms ? !truth.violated() : !truth.satisfied()) continue;
        const double rho = alarms ? static_cast<double>(highest_.verdict(monitor).robustness)
                                  : -static_cast<double>(lowest_.verdict(monitor).robustness);
        score.worst = score.steps == 0 ? rho : std::max(score.worst, rho);
        ++score.steps;
    }
}

/// Adds the scores of an episode to those of its group, which take the worst.
void add(std::vector<MonitorScores>& groups, std::uint32_t group, MonitorScores scores) {
    if (group == groups.size()) {
        groups.push_back(std::move(scores));
        return;
    }
    for (std::size_t i = 0; i < scores.size(); ++i) {
        MonitorScore& of = groups[group][i];
        if (scores[i].steps > 0)
            of.worst = of.steps == 0 ? scores[i].worst : std::max(of.worst, scores[i].worst);
        of.steps += scores[i].steps;
        of.unknown += scores[i].unknown;
    }
}

/// Scores of a monitor in all groups.
struct Totals {
    std::uint64_t with_score = 0;
    std::uint64_t steps = 0;
    std::uint64_t unknown = 0;
    std::vector<double> scores;

    Totals(const std::vector<MonitorScores>& groups, std::size_t of) {
        for (const MonitorScores& group : groups) {
            const MonitorScore& score = group[of];
            steps += score.steps;
            unknown += score.unknown;
            if (score.steps == 0) continue;
            ++with_score;
            scores.push_back(score.worst);
        }
    }
};

void refuse(const check::Monitor& monitor, const Totals& totals, const episodes::Groups& groups,
            Refusal refusal, diag::Sink& sink) {
    const std::string episodes = counted(groups.episodes(), "episode");
    const check::Threshold& threshold = monitor.calibration->threshold;
    if (refusal == Refusal::no_positives)
        sink.report(Code::no_positive_frame, threshold.span,
                    fmt::format("the ground truth of '{}' is {} at no step of {}, so there is "
                                "nothing to learn its shift from",
                                monitor.name, truth_word(monitor), episodes));
    else if (refusal == Refusal::too_few)
        refuse_too_few(threshold,
                       {totals.with_score, groups.are_named() ? "group" : "episode",
                        fmt::format(" in which the ground truth of '{}' is {} at some step",
                                    monitor.name, truth_word(monitor)),
                        "step", groups.count(), groups.are_named() ? episodes : ""},
                       sink);
    else
        refuse_infinite(monitor.name, threshold, "shift", sink);
}

thresholds::Entry entry_of_monitor(const check::Model& model, const check::Monitor& monitor,
                                   const Fitted& fitted, const episodes::Identities& episodes,
                                   const check::Labelling& labelling) {
    thresholds::Entry entry =
        entry_of(monitor.calibration->threshold, fitted, check::reads(model, monitor, labelling));
    entry.against = check::word(monitor.calibration->against);
    episodes.for_each([&](std::size_t, const episodes::Recorded& episode) {
        entry.episodes.push_back(episodes::hash_of(episode));
    });
    return entry;
}

std::string monitor_report(const check::Model& model, const check::Monitor& monitor,
                           const Totals& totals, const Fitted& fitted,
                           const episodes::Groups& groups) {
    const char* const each = groups.are_named() ? "group" : "episode";
    std::string text = fmt::format(
        "\n{}: rho of {} less {:.9g}\n"
        "    conformal, alpha = {}: {} whose ground truth is {} at some step\n"
        "    {}; given these {}, with probability >= 1 - {:.3f} to 1 - {:.3f} (5 % and 95 % "
        "quantiles, without ties)\n",
        monitor.name, check::shown(model, monitor.formula), fitted.epsilon,
        monitor.calibration->threshold.alpha, describe_place(fitted, against_alarms(monitor), each),
        truth_word(monitor), check::text(check::claims(model, monitor)[0]),
        groups.are_named() ? counted(fitted.n, "group") : std::to_string(fitted.n),
        1 - check::coverage_quantile(fitted.n, fitted.k, 0.05),
        1 - check::coverage_quantile(fitted.n, fitted.k, 0.95));
    if (totals.with_score < groups.count())
        text += fmt::format("    {} without such a step left out\n",
                            counted(groups.count() - totals.with_score, each));
    if (totals.unknown > 0)
        text += fmt::format("    {} skipped, where a missing label leaves the ground truth open\n",
                            counted(totals.unknown, "step"));
    return text;
}

/// Returns the guarantees of the monitors that are calibrated as a whole.
std::vector<Guaranteed> guaranteed_as_a_whole(const check::Model& model) {
    std::vector<Guaranteed> found;
    for (const Index m : calibrated_monitors(model))
        found.push_back({m, check::claims(model, model.monitors[m])[0]});
    return found;
}

LeftOut shifts_without_each(const check::Monitor& monitor, const std::vector<MonitorScores>& scores,
                            std::size_t of) {
    std::vector<Evidence::Reach> worst;
    for (std::uint32_t g = 0; g < scores.size(); ++g)
        if (scores[g][of].steps > 0) worst.push_back({scores[g][of].worst, g});
    return left_out(*monitor.calibration, worst, scores.size());
}

/// Returns the predicates that are not their own truth or have labels in the first episode.
std::vector<Index> find_labelled(const check::Model& model, const std::vector<Index>& monitors,
                                 const std::vector<Index>& in_first) {
    std::set<Index> found;
    for (const Index monitor : monitors)
        for (const Index predicate : check::predicates_of(model, model.monitors[monitor]))
            if (!check::is_own_truth(model, predicate) ||
                std::binary_search(in_first.begin(), in_first.end(), predicate))
                found.insert(predicate);
    return {found.begin(), found.end()};
}

}  // namespace

std::vector<Index> calibrated_monitors(const check::Model& model) {
    std::vector<Index> found;
    for (Index m = 0; m < model.monitors.size(); ++m)
        if (model.monitors[m].calibration) found.push_back(m);
    return found;
}

check::Model unshifted(check::Model model) {
    for (check::Monitor& monitor : model.monitors) monitor.calibration.reset();
    return model;
}

std::optional<Calibration> calibrate_monitors(const check::Model& model, thresholds::File before,
                                              const Request& request, diag::Sink& sink) {
    const std::vector<Index> monitors = calibrated_monitors(model);
    if (!episodes::can_be_dealt(request.episodes, request.reading, request.folds, model, sink))
        return std::nullopt;
    const auto in_first = episodes::labelled_in_first(model, request, sink);
    if (!in_first) return std::nullopt;
    const std::vector<Index> labelled = find_labelled(model, monitors, *in_first);
    const check::Model plain = unshifted(model);
    const episodes::GroundTruth truth = episodes::ground_truth(plain, labelled);
    const auto compiled = compile(plain, {}, sink);
    // The truth does not depend on rho.
    const auto truths = compile(truth.model, {{}, check::Values::boolean}, sink);
    if (!compiled || !truths) return std::nullopt;
    const MonitorPlans plans{compiled->plan, truths->plan, truth};

    const episodes::Leaks leaks(model, labelled);
    episodes::Identities recorded;
    episodes::Groups groups;
    std::vector<MonitorScores> scored;  // per group
    const std::vector<Guaranteed> guarantees = guaranteed_as_a_whole(model);
    const Watched watched = watched_by(model, guarantees, labelled, *in_first);
    Tracks tracks;
    bool is_divided = true;
    std::uint64_t frames = 0;
    check::Labelling labelling;
    const bool all_scored = episodes::over_shared_episodes<MonitorEpisode>(
        request.episodes, request, sink,
        [&] {
            return std::make_unique<MonitorScorer>(model, plans, leaks, monitors, watched,
                                                   request.reading);
        },
        [&](std::size_t, MonitorEpisode episode) {
            recorded.add(episode);
            frames += episode.frames;
            ++labelling.episodes;
            for (const Index predicate : episode.from_arrays) ++labelling.from_arrays[predicate];
            add(scored, groups.add(episode.group), std::move(episode.scores));
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
    for (std::size_t i = 0; i < monitors.size(); ++i) {
        const check::Monitor& monitor = model.monitors[monitors[i]];
        const Totals totals(scored, i);
        Fit fit = fit_rank(totals.scores, monitor.calibration->threshold.alpha);
        if (const auto* refusal = std::get_if<Refusal>(&fit)) {
            refuse(monitor, totals, groups, *refusal, sink);
            continue;
        }
        auto& fitted = std::get<Fitted>(fit);
        fitted.scores = totals.scores;
        mirror(fitted, against_alarms(monitor));
        warn_of_large_alpha(monitor.name, monitor.calibration->threshold, sink);
        result.file.monitors[monitor.name] =
            entry_of_monitor(model, monitor, fitted, recorded, labelling);
        check::Threshold& shift = shifted.monitors[monitors[i]].calibration->threshold;
        shift.value = fitted.epsilon;
        shift.n = fitted.n;
        shift.k = fitted.k;
        shift.by_group = groups.are_named();
        reports.push_back(
            monitor_report(shifted, shifted.monitors[monitors[i]], totals, fitted, groups));
        out.push_back(shifts_without_each(monitor, scored, i));
    }
    if (sink.has_errors()) return std::nullopt;
    const auto others = other_errors_of_shifts(shifted, guarantees, out,
                                               {tracks, watched, groups, true, is_divided});
    result.report = fmt::format("{}{}, {}\n", counted(groups.episodes(), "episode"),
                                in_groups(groups), counted(frames, "frame"));
    for (std::size_t i = 0; i < monitors.size(); ++i) {
        result.report += reports[i] + describe(others[i], guarantees[i], "    ");
        warn_of_empty(model, guarantees[i], others[i], sink);
    }
    result.report += "\n" + note_on_other_errors(groups.are_named());
    result.report += report_of_folds(model, monitors, scored, recorded, groups, request.folds);
    thresholds::drop_unused_recordings(result.file);
    for (const thresholds::Allowance& used : result.file.allowances)
        result.report += fmt::format("\n{}\n", thresholds::text(used));
    result.report += episodes::remark_on(allowance);
    return result;
}

}  // namespace etlc::calibrate
