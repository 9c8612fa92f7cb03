#include "calibrate/scores.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "calibrate/bounds.hpp"

namespace etlc::calibrate {

namespace {

using check::ThresholdOrigin;

}  // namespace

std::vector<Index> calibrated_predicates(const check::Model& model) {
    std::vector<Index> found;
    for (Index i = 0; i < model.predicates.size(); ++i)
        if (model.predicates[i].threshold.origin != ThresholdOrigin::literal) found.push_back(i);
    return found;
}

Scorer::Scorer(const check::Model& model, const Leaks& leaks, std::vector<Index> predicates,
               data::NamesInFile names)
    : model_(model),
      leaks_(leaks),
      predicates_(std::move(predicates)),
      plan_(plan::measuring(model, predicates_)),
      evaluator_(plan_),
      wanted_{&model, plan_.inputs, predicates_, identity_inputs(model)},
      names_(std::move(names)) {}

diag::Result<Demonstration> Scorer::score(const std::string& path) {
    auto recording = Recording::open(wanted_, [&](const std::vector<data::Channel>& channels) {
        return data::open_trace(path, data::renamed(channels, names_));
    });
    if (!recording) return recording.failure();
    Demonstration result;
    result.path = path;
    result.scores.resize(predicates_.size());
    evaluator_.reset();
    for (;;) {
        const auto more = recording->next();
        if (!more) return more.failure();
        if (!*more) break;
        evaluator_.step(recording->samples());
        for (std::size_t i = 0; i < predicates_.size(); ++i)
            add(predicates_[i], recording->label(predicates_[i]), result.scores[i]);
        if (!result.leak) result.leak = leaks_.find(recording->samples(), recording->frames() - 1);
    }
    for (std::size_t i = 0; i < predicates_.size(); ++i)
        result.scores[i].from_array = recording->from_array(predicates_[i]);
    result.hash = recording->hash();
    result.content = recording->content();
    result.frames = recording->frames();
    return result;
}

void Scorer::add(Index predicate, Label label, Scores& scores) const {
    if (label == Label::unknown) {
        ++scores.unlabelled;
        return;
    }
    const bool positive = label == Label::yes;
    ++(positive ? scores.positives : scores.negatives);
    const float delta = evaluator_.distance(predicate);
    if (std::isnan(delta)) {
        ++scores.unmeasured;
        return;
    }
    const check::Predicate& p = model_.predicates[predicate];
    const float score = p.upper_bound() ? delta : -delta;
    if (p.threshold.origin == ThresholdOrigin::f1) {
        scores.labelled.push_back({score, positive});
        return;
    }
    if (!positive) return;
    const Interval interval = *interval_of(model_, predicate, evaluator_);
    const double reach = p.upper_bound() ? interval.high : -interval.low;
    scores.worst_reach = scores.has_score ? std::max(scores.worst_reach, reach) : reach;
    scores.has_score = true;
    if (p.threshold.origin == ThresholdOrigin::class_conditional) scores.reaches.push_back(reach);
}

}  // namespace etlc::calibrate
