#include "calibrate/scores.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "calibrate/bounds.hpp"
#include "plan/plan.hpp"

namespace etlc::calibrate {

using check::ThresholdOrigin;
using episodes::Label;

void Evidence::add(const Scores& scores) {
    const auto demonstration = static_cast<std::uint32_t>(demonstrations++);
    from_array += scores.from_array ? 1 : 0;
    positives += scores.positives;
    negatives += scores.negatives;
    unlabelled += scores.unlabelled;
    unmeasured += scores.unmeasured;
    if (scores.has_score) worst.push_back({scores.worst_reach, demonstration});
    for (const double reach : scores.reaches) reaches.add({reach, demonstration});
    for (const Scores::Labelled& frame : scores.labelled)
        labelled.add({frame.score, demonstration, frame.positive});
}

std::vector<Index> calibrated_predicates(const check::Model& model) {
    std::vector<Index> found;
    for (Index i = 0; i < model.predicates.size(); ++i)
        if (model.predicates[i].threshold.origin != ThresholdOrigin::literal) found.push_back(i);
    return found;
}

Scorer::Scorer(const check::Model& model, const episodes::Leaks& leaks,
               std::vector<Index> predicates, episodes::ReadOptions reading)
    : model_(model),
      predicates_(std::move(predicates)),
      plan_(plan::measuring(model, predicates_)),
      measured_(plan_),
      wanted_(episodes::wanted(model, {&plan_}, predicates_, leaks)),
      reading_(std::move(reading)) {}

diag::Result<Demonstration> Scorer::score(const std::string& path) {
    auto recording = episodes::Recording::open(wanted_, path, reading_);
    if (!recording) return recording.failure();
    std::vector<Scores> scores(predicates_.size());
    const auto done = episodes::replay(*recording, {&measured_}, [&] {
        for (std::size_t i = 0; i < predicates_.size(); ++i)
            add(predicates_[i], recording->label(predicates_[i]), scores[i]);
        return true;
    });
    if (!done) return done.failure();
    for (std::size_t i = 0; i < predicates_.size(); ++i) {
        scores[i].from_array = recording->from_array(predicates_[i]);
        scores[i].labelled.shrink_to_fit();  // they are kept for all episodes
    }
    return Demonstration{recording->recorded(), std::move(scores)};
}

void Scorer::add(Index predicate, Label label, Scores& scores) const {
    if (label == Label::unknown) {
        ++scores.unlabelled;
        return;
    }
    const bool positive = label == Label::yes;
    ++(positive ? scores.positives : scores.negatives);
    const float delta = measured_.evaluator().distance(predicate);
    if (std::isnan(delta)) {
        ++scores.unmeasured;
        return;
    }
    const check::Predicate& p = model_.predicates[predicate];
    const float score = p.upper_bound() ? delta : -delta;
    scores.labelled.push_back({score, positive});
    if (!positive || p.threshold.origin == ThresholdOrigin::f1) return;
    const Interval interval = *interval_of(model_, predicate, measured_.evaluator());
    const double reach = p.upper_bound() ? interval.high : -interval.low;
    scores.worst_reach = scores.has_score ? std::max(scores.worst_reach, reach) : reach;
    scores.has_score = true;
    if (p.threshold.origin == ThresholdOrigin::class_conditional) scores.reaches.push_back(reach);
}

}  // namespace etlc::calibrate
