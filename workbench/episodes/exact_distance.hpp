// Distances in double: what truths compare, and no monitor.
// Takes: a distance of the model and its point. Gives: the aggregated distance. Keeps true: the
// target set and the weights are the float32 numbers that the monitor has, everything computed from
// them is double.
#pragma once

#include <optional>
#include <vector>

#include "check/model/model.hpp"

namespace etlc::episodes {

/// d(point, target) aggregated over the target set; `point` has as many elements as the target has
/// columns. Nothing for the zero vector under cosine and angular, which has no direction.
std::optional<double> exact_distance(const check::Model& model, const check::Distance& distance,
                                     const std::vector<double>& point);

/// What the distance makes of its rows' distances, of which there is at least one.
double aggregate(const check::Distance& distance, std::vector<double> rows);

}  // namespace etlc::episodes
