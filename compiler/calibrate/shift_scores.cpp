#include "calibrate/shift_scores.hpp"

#include <algorithm>
#include <set>

#include "calibrate/bounds.hpp"

namespace etlc::calibrate {

namespace {

/// The predicate's robustness as low and as high as any build may have it.
plan::Value spread(const check::Model& model, Index predicate, const plan::Evaluator& measured) {
    const Interval delta = *interval_of(model, predicate, measured);
    const check::Predicate& p = model.predicates[predicate];
    const float epsilon = p.threshold.value;
    const float low = p.upper_bound() ? epsilon - up(delta.high) : down(delta.low) - epsilon;
    const float high = p.upper_bound() ? epsilon - down(delta.low) : up(delta.high) - epsilon;
    return {etlmon::key_of(low), etlmon::key_of(high)};
}

std::size_t position(const plan::Plan& plan, Index monitor) {
    const auto at = std::find_if(plan.monitors.begin(), plan.monitors.end(),
                                 [&](const plan::Monitor& m) { return m.index == monitor; });
    return static_cast<std::size_t>(at - plan.monitors.begin());
}

/// Inputs that either plan reads, labels aside, and those that tell episodes apart.
std::vector<Index> inputs_of(const check::Model& model, const MonitorPlans& plans) {
    std::set<Index> inputs(plans.monitors.inputs.begin(), plans.monitors.inputs.end());
    for (const Index input : plans.truths.inputs)
        if (input < model.inputs.size()) inputs.insert(input);
    for (const Index input : identity_inputs(model)) inputs.insert(input);
    return {inputs.begin(), inputs.end()};
}

}  // namespace

MonitorScorer::MonitorScorer(const check::Model& model, const MonitorPlans& plans,
                             const Leaks& leaks, const std::vector<Index>& monitors,
                             const data::NamesInFile& names)
    : model_(model),
      plans_(plans),
      leaks_(leaks),
      monitors_(monitors),
      names_(names),
      highest_(plans.monitors),
      lowest_(plans.monitors),
      truths_(plans.truths),
      wanted_{&model, inputs_of(model, plans), labelled_predicates(plans.ground_truth),
              identity_inputs(model)} {
    for (const Index monitor : monitors) {
        said_at_.push_back(position(plans.monitors, monitor));
        truth_at_.push_back(position(plans.truths, monitor));
    }
    lowest_.replace_literals([this](Index p) { return spread(model_, p, lowest_); });
    // A verdict reads the low end: of a literal that is the first end, of a negated one the second.
    // With the ends exchanged it is the highest that a build may have, while the range of a missing
    // sample stays as it is.
    highest_.replace_literals([this](Index p) {
        const plan::Value value = spread(model_, p, highest_);
        return plan::Value{value.high, value.low};
    });
}

diag::Result<MonitorEpisode> MonitorScorer::score(const std::string& path) {
    auto recording = Recording::open(wanted_, [&](const std::vector<data::Channel>& channels) {
        return data::open_trace(path, data::renamed(channels, names_));
    });
    if (!recording) return recording.failure();
    MonitorEpisode result;
    result.path = path;
    result.scores.resize(monitors_.size());
    for (plan::Evaluator* evaluator : {&highest_, &lowest_, &truths_}) evaluator->reset();
    for (;;) {
        const auto more = recording->next();
        if (!more) return more.failure();
        if (!*more) break;
        if (!result.leak) result.leak = leaks_.find(recording->samples(), recording->frames() - 1);
        std::vector<plan::Sample> labelled = recording->samples();
        labelled.resize(plans_.ground_truth.model.inputs.size());
        for (const Index predicate : wanted_.predicates)
            labelled[plans_.ground_truth.inputs[predicate]] =
                sample_of(recording->label(predicate));
        note(truths_.step(labelled), highest_.step(recording->samples()),
             lowest_.step(recording->samples()), result);
    }
    std::uint32_t last_positions = 0;
    for (const plan::Monitor& monitor : plans_.monitors.monitors)
        last_positions = std::max(last_positions, monitor.horizon);
    for (std::uint32_t call = 0; recording->frames() > 0 && call < last_positions; ++call)
        note(truths_.finish(), highest_.finish(), lowest_.finish(), result);
    result.hash = recording->hash();
    result.content = recording->content();
    result.frames = recording->frames();
    return result;
}

void MonitorScorer::note(const std::vector<etlmon::Verdict>& truths,
                         const std::vector<etlmon::Verdict>& highest,
                         const std::vector<etlmon::Verdict>& lowest,
                         MonitorEpisode& episode) const {
    for (std::size_t i = 0; i < monitors_.size(); ++i) {
        const etlmon::Verdict& truth = truths[truth_at_[i]];
        if (!truth.decided()) continue;
        MonitorScore& score = episode.scores[i];
        if (truth.unknown()) ++score.unknown;
        const bool alarms =
            model_.monitors[monitors_[i]].calibration->against == check::Against::missed_alarm;
        if (alarms ? !truth.violated() : !truth.satisfied()) continue;
        const double rho = alarms ? static_cast<double>(highest[said_at_[i]].robustness)
                                  : -static_cast<double>(lowest[said_at_[i]].robustness);
        score.worst = score.steps == 0 ? rho : std::max(score.worst, rho);
        ++score.steps;
    }
}

}  // namespace etlc::calibrate
