#include "calibrate/scores.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "calibrate/bounds.hpp"

namespace etlc::calibrate {

namespace {

using check::Expr;
using check::ThresholdOrigin;

void collect_distances(const Expr& e, std::vector<Index>& distances) {
    if (e.kind == Expr::Kind::distance) distances.push_back(e.index);
    for (const Expr& argument : e.arguments) collect_distances(argument, distances);
}

/// z = c g with c > 0, as far as float32 can tell: an embedding and its normalised copy.
bool same_direction(const float* z, const float* g, std::uint32_t dimension) {
    constexpr double kFourRoundings = 4 * 0x1p-24;
    double z_square = 0;
    double g_square = 0;
    for (std::uint32_t i = 0; i < dimension; ++i) {
        z_square += static_cast<double>(z[i]) * static_cast<double>(z[i]);
        g_square += static_cast<double>(g[i]) * static_cast<double>(g[i]);
    }
    const double factor = std::sqrt(z_square / g_square);
    for (std::uint32_t i = 0; i < dimension; ++i) {
        const double scaled = static_cast<double>(g[i]) * factor;
        if (!(std::abs(static_cast<double>(z[i]) - scaled) <= kFourRoundings * std::abs(scaled))) return false;
    }
    return true;
}

}  // namespace

std::vector<Index> calibrated_predicates(const check::Model& model) {
    std::vector<Index> found;
    for (Index i = 0; i < model.predicates.size(); ++i)
        if (model.predicates[i].threshold.origin != ThresholdOrigin::literal) found.push_back(i);
    return found;
}

Scorer::Scorer(const check::Model& model, std::vector<Index> predicates, data::NamesInFile names)
    : model_(model),
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
        if (!result.leak) result.leak = leak(recording->frames() - 1);
    }
    for (std::size_t i = 0; i < predicates_.size(); ++i)
        result.scores[i].from_array = recording->from_array(predicates_[i]);
    result.hash = recording->hash();
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
    scores.worst = scores.has_score ? std::max(scores.worst, score) : score;
    scores.worst_reach = scores.has_score ? std::max(scores.worst_reach, reach) : reach;
    scores.has_score = true;
    if (p.threshold.origin == ThresholdOrigin::class_conditional) scores.reaches.push_back(reach);
}

/// Only embeddings: that a vector of scalars is where a target is may well happen again.
std::optional<Leak> Scorer::leak(std::uint64_t frame) const {
    for (const Index predicate : predicates_) {
        std::vector<Index> distances;
        collect_distances(model_.predicates[predicate].expression, distances);
        for (const Index d : distances) {
            const check::Distance& distance = model_.distances[d];
            const etlmon::Measured measured = evaluator_.measured(d);
            if (distance.point_is_vector || std::isnan(measured.delta)) continue;
            // A frame that is a row is nearest to it, or to another copy of it.
            if (is_row(distance, measured.nearest)) return Leak{predicate, distance.target, measured.nearest, frame};
        }
    }
    return std::nullopt;
}

bool Scorer::is_row(const check::Distance& distance, std::uint32_t row) const {
    const check::Target& target = model_.targets[distance.target];
    const float* z = evaluator_.input(distance.point[0]);
    const float* g = target.values.data() + static_cast<std::size_t>(row) * target.dimension;
    const bool of_directions = distance.metric == check::Metric::cosine || distance.metric == check::Metric::angular;
    if (of_directions && target.dimension > 1) return same_direction(z, g, target.dimension);
    return std::equal(z, z + target.dimension, g);
}

}  // namespace etlc::calibrate
