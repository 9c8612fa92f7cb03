// The measuring half of the evaluator: distances and expressions of one step, through the runtime's own kernels.
#include <algorithm>

#include "etlmon/dynamic.hpp"
#include "etlmon/expression.hpp"
#include "plan/evaluator.hpp"
#include "plan/kernels.hpp"

namespace etlc::plan {

namespace {

using check::Expr;

etlmon::AggregationId aggregation_id(check::Aggregation aggregation) {
    using enum check::Aggregation;
    switch (aggregation) {
        case min: return etlmon::AggregationId::min;
        case max: return etlmon::AggregationId::max;
        case mean: return etlmon::AggregationId::mean;
        case kth: break;
    }
    return etlmon::AggregationId::kth;
}

}  // namespace

void Evaluator::prepare_distances() {
    prepared_.resize(model_.distances.size());
    points_.resize(model_.distances.size());
    std::size_t scratch = 0;
    for (Index d : plan_.distances) {
        const check::Distance& distance = model_.distances[d];
        prepared_[d] = prepared_rows(model_, distance);
        points_[d].resize(distance.point_is_vector ? distance.point.size() : 0);
        scratch = std::max<std::size_t>(scratch, distance.kth);
    }
    scratch_.resize(scratch);
}

void Evaluator::measure_distances() {
    for (Index d : plan_.distances) {
        const check::Distance& distance = model_.distances[d];
        const bool present = std::all_of(distance.point.begin(), distance.point.end(),
                                         [&](Index input) { return inputs_[input] != nullptr; });
        distances_[d] = {etlmon::kMissing, 0};
        if (!present) continue;
        const float* z = inputs_[distance.point[0]];
        if (distance.point_is_vector) {
            for (std::size_t i = 0; i < distance.point.size(); ++i) points_[d][i] = *inputs_[distance.point[i]];
            z = points_[d].data();
        }
        const check::Target& target = model_.targets[distance.target];
        distances_[d] = etlmon::measure(metric_id(distance), aggregation_id(distance.aggregation), distance.kth, z,
                                        prepared_[d].data(), target.rows, target.dimension, distance.weights.data(),
                                        scratch_.data());
    }
}

/// EXPR in float32, each operation rounded once; NaN where an operand is.
float Evaluator::expression(const Expr& e) const {
    const auto at = [&](std::size_t i) { return expression(e.arguments[i]); };
    const auto fold = [&](auto combine) {
        float result = at(0);
        for (std::size_t i = 1; i < e.arguments.size(); ++i) result = combine(result, at(i));
        return result;
    };
    switch (e.kind) {
        case Expr::Kind::number: return e.number32;
        case Expr::Kind::scalar: return *inputs_[e.index];
        case Expr::Kind::distance: return distances_[e.index].delta;
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

}  // namespace etlc::plan
