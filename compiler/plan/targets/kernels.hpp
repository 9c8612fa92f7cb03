// Calls the runtime's kernels for distances of the model. Rows are prepared in double and in fixed
// order, so every machine gets the same constants; the kernels are compiled only here.
#pragma once

#include <string>
#include <vector>

#include "check/model/model.hpp"
#include "etlmon/distance/aggregate.hpp"
#include "etlmon/hosted/table.hpp"

namespace etlc::plan {

/// Returns the row of etlmon/distance/distances.def.
etlmon::MetricId metric_id(const check::Distance& distance);
etlmon::AggregationId aggregation_id(const check::Distance& distance);

/// Returns K x D float32, row-major: of length 1 for cosine and angular, else as given.
std::vector<float> prepared_rows(const check::Model& model, const check::Distance& distance);
bool rows_as_given(const check::Distance& distance);

/// Returns the struct of etlmon/distance/distances.hpp: "L2".
std::string metric_name(const check::Distance& distance);

/// Measures the distance from z to `rows` prepared rows, as generated code does. `scratch`: for
/// kth, as many floats as it counts.
/// Measures between two points of a model; `scratch`: the dimension of floats, for cosine and
/// angular.
etlmon::Measured measure_between(const check::Distance& distance, const float* a, const float* b,
                                 std::uint32_t dimension, float* scratch);

etlmon::Measured measure(const check::Distance& distance, const float* z, const float* targets,
                         std::uint32_t rows, std::uint32_t dimension, float* scratch);

/// Computes A (z - m) as generated code does; returns false where it is unknown.
bool project(const check::Projection& map, const std::vector<float>& z, std::vector<float>& y);

}  // namespace etlc::plan
