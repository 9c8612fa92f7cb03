#include "calibrate/shift_scores.hpp"

#include <algorithm>

#include "calibrate/bounds.hpp"
#include "check/numbers/decimal.hpp"

namespace etlc::calibrate {

namespace {

using check::round_down;
using check::round_up;

/// The predicate's robustness as low and as high as any build may have it.
plan::Value spread(const check::Model& model, Index predicate, const plan::Evaluator& measured) {
    const Interval delta = *interval_of(model, predicate, measured);
    const check::Predicate& p = model.predicates[predicate];
    const float epsilon = p.threshold.value;
    const float low =
        p.upper_bound() ? epsilon - round_up(delta.high) : round_down(delta.low) - epsilon;
    const float high =
        p.upper_bound() ? epsilon - round_down(delta.low) : round_up(delta.high) - epsilon;
    return {etlmon::key_of(low), etlmon::key_of(high)};
}

}  // namespace

MonitorScorer::MonitorScorer(const check::Model& model, const MonitorPlans& plans,
                             const episodes::Leaks& leaks, const std::vector<Index>& monitors,
                             const data::NamesInFile& names)
    : model_(model),
      monitors_(monitors),
      names_(names),
      highest_(plans.monitors),
      lowest_(plans.monitors),
      truths_(plans.truths, &plans.ground_truth),
      wanted_(episodes::wanted(model, {&plans.monitors, &plans.truths},
                               episodes::labelled_predicates(plans.ground_truth), leaks)) {
    plan::Evaluator& lowest = lowest_.evaluator();
    lowest.replace_predicate_values([&](Index p) { return spread(model_, p, lowest); });
    // A verdict reads the low end: of a literal that is the first end, of a negated one the second.
    // With the ends exchanged it is the highest that a build may have, while the range of a missing
    // sample stays as it is.
    plan::Evaluator& highest = highest_.evaluator();
    highest.replace_predicate_values([&](Index p) {
        const plan::Value value = spread(model_, p, highest);
        return plan::Value{value.high, value.low};
    });
}

diag::Result<MonitorEpisode> MonitorScorer::score(const std::string& path) {
    auto recording = episodes::Recording::open(wanted_, path, names_);
    if (!recording) return recording.failure();
    std::vector<MonitorScore> scores(monitors_.size());
    const auto note_step = [&] {
        note(scores);
        return true;
    };
    const auto done =
        episodes::replay(*recording, {&truths_, &highest_, &lowest_}, note_step, note_step);
    if (!done) return done.failure();
    MonitorEpisode result{recording->recorded(), std::move(scores), {}};
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

}  // namespace etlc::calibrate
