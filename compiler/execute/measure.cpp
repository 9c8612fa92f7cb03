// The part of Evaluator that measures distances and expressions, by the runtime's kernels.
#include <algorithm>
#include <cmath>

#include "etlmon/distance/between.hpp"
#include "etlmon/distance/contrast.hpp"
#include "etlmon/hosted/dynamic.hpp"
#include "etlmon/hosted/dynamic_enclosed.hpp"
#include "etlmon/temporal/expression.hpp"
#include "execute/evaluator.hpp"
#include "plan/targets/kernels.hpp"
#include "plan/targets/narrow_targets.hpp"

namespace etlc::execute {

using namespace plan;

namespace {

using check::Expr;

bool doubtful(const etlmon::Enclosed& enclosed, const std::vector<Cut>& cuts) {
    return std::any_of(cuts.begin(), cuts.end(), [&](const Cut& cut) {
        const etlmon::Cut one[] = {{cut.low, cut.high}};
        return enclosed.doubtful(one);
    });
}

}  // namespace

const float* Evaluator::point(Index point, std::uint32_t ago) const {
    return ago == 0 ? point_at_[point] : earlier_of(point).at(points_are_kept_ ? ago + 1 : ago);
}

void Evaluator::measure_points() {
    points_are_kept_ = false;
    for (const Index p : tables_->measured_points) point_at_[p] = take_point(p);
}

const float* Evaluator::take_point(Index index) {
    const check::Point& point = model_.points[index];
    float* const elements = points_[index].data();
    if (point.is_projected()) {
        const float* const z = point_at_[point.inner];
        const check::Projection& map = model_.projections[point.projection];
        const float* const offset = map.offset.empty() ? nullptr : map.offset.data();
        const bool known =
            z != nullptr && etlmon::project(z, map.matrix.data(), offset, map.rows, map.dimension,
                                            centred_.data(), elements);
        return known ? elements : nullptr;
    }
    if (point.is_delayed()) return earlier_of(point.inner).at(point.steps);
    if (point.is_joined()) return join(point, elements);
    if (point.is_sum()) return sum(point, elements);
    if (!point.is_vector()) return inputs_[point.inputs[0]];
    for (std::size_t i = 0; i < point.inputs.size(); ++i) {
        if (inputs_[point.inputs[i]] == nullptr) return nullptr;
        elements[i] = *inputs_[point.inputs[i]];
    }
    return elements;
}

const float* Evaluator::join(const check::Point& point, float* elements) const {
    float* end = elements;
    for (const Index part : point.parts) {
        if (point_at_[part] == nullptr) return nullptr;
        end = std::copy_n(point_at_[part], model_.points[part].dimension, end);
    }
    return elements;
}

const float* Evaluator::sum(const check::Point& point, float* elements) const {
    for (const Index part : point.parts)
        if (point_at_[part] == nullptr) return nullptr;
    std::fill_n(elements, point.dimension, 0.0F);
    for (std::size_t i = 0; i < point.parts.size(); ++i)
        etlmon::detail::add_term({point.factors[i], point_at_[point.parts[i]]}, point.dimension,
                                 elements);
    return etlmon::finite(elements, point.dimension) ? elements : nullptr;
}

const EarlierSamples& Evaluator::earlier_of(Index point) const {
    return *std::find_if(state_->earlier.begin(), state_->earlier.end(),
                         [&](const EarlierSamples& earlier) { return earlier.point() == point; });
}

/// Adds the points of this step to those of earlier steps, after all have been measured.
void Evaluator::keep_points() {
    for (EarlierSamples& earlier : state_->earlier) earlier.push(point_at_[earlier.point()]);
    points_are_kept_ = true;
}

void Evaluator::measure_distances() {
    measure_points();
    for (Index d : plan_.distances) {
        const float* const z = point_at_[model_.distances[d].point];
        distances_[d] = {etlmon::kMissing, 0};
        enclosed_[d] = {};
        if (z == nullptr) continue;
        if (const Index other = model_.distances[d].other; other != kNone) {
            if (point_at_[other] == nullptr) continue;
            enclosed_[d] = etlmon::exactly(measure_between(
                model_.distances[d], z, point_at_[other], model_.dimension_of(d), scratch_.data()));
            distances_[d] = enclosed_[d].measured;
            continue;
        }
        enclosed_[d] = measure(d, z);
        distances_[d] = enclosed_[d].measured;
    }
}

etlmon::Measured Evaluator::measure_wide(Index d, const float* z) {
    const check::Distance& distance = model_.distances[d];
    const check::Target& target = model_.targets[distance.target];
    return plan::measure(distance, z, tables_->prepared[d].data(), target.rows, target.dimension,
                         scratch_.data());
}

/// Measures a contrast within bounds; on float32 where these leave the comparison open.
etlmon::Enclosed Evaluator::measure_contrast(const check::Predicate& predicate) {
    const auto [a, b] = *contrast(predicate);
    const Index p = static_cast<Index>(&predicate - model_.predicates.data());
    const etlmon::Enclosed known = etlmon::difference(enclosed_[a], enclosed_[b]);
    state_->contrast_rows[p] = {distances_[a].nearest, distances_[b].nearest};
    if (!doubtful(known, tables_->contrast_cuts[p])) return known;
    const auto wide = [&](Index d) {
        return measure_wide(d, point_at_[model_.distances[d].point]);
    };
    const etlmon::Measured left = wide(a), right = wide(b);
    state_->contrast_rows[p] = {left.nearest, right.nearest};
    return etlmon::difference(etlmon::exactly(left), etlmon::exactly(right));
}

std::uint32_t Evaluator::nearest(Index p, Index distance) const {
    const check::Predicate& predicate = model_.predicates[p];
    if (predicate.plain_distance()) return state_->measured[p].nearest;
    if (tables_->contrast_cuts[p].empty() || std::isnan(state_->measured[p].delta))
        return distances_[distance].nearest;
    return distance == contrast(predicate)->first ? state_->contrast_rows[p].first
                                                  : state_->contrast_rows[p].second;
}

/// Measures on narrow rows if there are any; on float32 if there are none or they leave a
/// comparison open. Kernels give narrow rows and their widened copies the same bits
/// (tests/runtime/test_narrow_*.cpp), so one kernel suffices.
etlmon::Enclosed Evaluator::measure(Index d, const float* z) {
    const check::Distance& distance = model_.distances[d];
    const check::Target& target = model_.targets[distance.target];
    const auto measured_on = [&](const std::vector<float>& rows) {
        return plan::measure(distance, z, rows.data(), target.rows, target.dimension,
                             scratch_.data());
    };
    if (near_.contains(d)) return etlmon::exactly(measure_near(d, z));
    const NarrowSet* set = tables_->narrow[d];
    if (set == nullptr) return etlmon::exactly(measure_wide(d, z));
    if (set->lossless) return etlmon::exactly(measured_on(tables_->widened[d]));
    const etlmon::Enclosed enclosed =
        etlmon::enclose(metric_id(distance), aggregation_id(distance),
                        measured_on(tables_->widened[d]), set->moved, set->rows, set->dimension);
    return doubtful(enclosed, set->cuts) ? etlmon::exactly(measure_wide(d, z)) : enclosed;
}

/// Measures the candidates only. Kernels give a row the same bits whatever other rows they measure
/// (tests/runtime/test_kernel_twins.cpp).
etlmon::Measured Evaluator::measure_near(Index d, const float* z) {
    const check::Distance& distance = model_.distances[d];
    const std::uint32_t dimension = model_.targets[distance.target].dimension;
    const std::vector<std::uint32_t>& rows = near_rows(d, z, 2);
    near_values_.clear();
    for (const std::uint32_t row : rows) {
        const auto begin =
            tables_->prepared[d].begin() + static_cast<std::ptrdiff_t>(row) * dimension;
        near_values_.insert(near_values_.end(), begin, begin + dimension);
    }
    etlmon::Measured measured =
        plan::measure(distance, z, near_values_.data(), static_cast<std::uint32_t>(rows.size()),
                      dimension, scratch_.data());
    if (measured.nearest < rows.size()) measured.nearest = rows[measured.nearest];
    return measured;
}

/// Advances the numbers that earlier steps have a part in, each after those that it contains.
void Evaluator::take_pasts() {
    for (std::size_t i = 0; i < state_->pasts.size(); ++i) {
        const Index past = plan_.pasts[i];
        past_operands_[past] = expression(model_.pasts[past].expression);
        pasts_[past] = state_->pasts[i].push(past_operands_[past]);
    }
    if (after_pasts_) after_pasts_();
}

/// Evaluates EXPR in float32, rounding each operation once; NaN where an operand is.
float Evaluator::expression(const Expr& e) const {
    const auto at = [&](std::size_t i) { return expression(e.arguments[i]); };
    const auto fold = [&](auto combine) {
        float result = at(0);
        for (std::size_t i = 1; i < e.arguments.size(); ++i) result = combine(result, at(i));
        return result;
    };
    switch (e.kind) {
        case Expr::Kind::number: return e.number32;
        case Expr::Kind::scalar:
            return inputs_[e.index] == nullptr ? etlmon::kMissing : *inputs_[e.index];
        case Expr::Kind::distance: return distances_[e.index].delta;
        case Expr::Kind::past: return pasts_[e.index];
        case Expr::Kind::negate: return etlmon::negate(at(0));
        case Expr::Kind::add: return etlmon::add(at(0), at(1));
        case Expr::Kind::subtract: return etlmon::subtract(at(0), at(1));
        case Expr::Kind::multiply: return etlmon::multiply(at(0), at(1));
        case Expr::Kind::divide: return etlmon::divide(at(0), at(1));
        case Expr::Kind::abs: return etlmon::absolute(at(0));
        case Expr::Kind::sqrt: return etlmon::root(at(0));
        case Expr::Kind::min: return fold([](float a, float b) { return etlmon::smaller(a, b); });
        case Expr::Kind::max: return fold([](float a, float b) { return etlmon::greater(a, b); });
    }
    return etlmon::kMissing;
}

}  // namespace etlc::execute
