// Distances in double, for truths; monitors compute in float32. The target set and the weights are
// the monitor's float32 numbers, everything computed from them is double.
#pragma once

#include <optional>
#include <vector>

#include "check/model/model.hpp"

namespace etlc::episodes {

/// Returns d(point, target) aggregated over the target set; `point` has as many elements as the
/// target has columns. Returns nothing for the zero vector under cosine and angular, because it has
/// no direction.
std::optional<double> exact_distance(const check::Model& model, const check::Distance& distance,
                                     const std::vector<double>& point);

/// Returns d(point, other) likewise.
std::optional<double> exact_distance(const check::Distance& distance,
                                     const std::vector<double>& point,
                                     const std::vector<double>& other);

/// Aggregates the distances of the rows, of which there is at least one.
double aggregate(const check::Distance& distance, std::vector<double> rows);

}  // namespace etlc::episodes
