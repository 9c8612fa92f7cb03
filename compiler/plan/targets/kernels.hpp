// What the runtime's kernels are called with.
// Takes: a distance of the model. Gives: the rows of its target set in the form that the kernel
// wants, its name there, and what the kernel measures. Keeps true: rows are computed in double and
// in fixed order, so every machine makes the same constants; the kernels are compiled here alone.
#pragma once

#include <string>
#include <vector>

#include "check/model/model.hpp"
#include "etlmon/distance/aggregate.hpp"
#include "etlmon/hosted/table.hpp"

namespace etlc::plan {

/// The row of etlmon/distance/distances.def.
etlmon::MetricId metric_id(const check::Distance& distance);
etlmon::AggregationId aggregation_id(const check::Distance& distance);

/// K x D float32, row-major: of length 1 for cosine and angular, else as given.
std::vector<float> prepared_rows(const check::Model& model, const check::Distance& distance);
bool rows_as_given(const check::Distance& distance);

/// The struct of etlmon/distance/distances.hpp: "L2".
std::string metric_name(const check::Distance& distance);

/// The distance from z to `rows` prepared rows, as generated code measures it. `scratch`: for kth,
/// as many floats as it counts.
etlmon::Measured measure(const check::Distance& distance, const float* z, const float* targets,
                         std::uint32_t rows, std::uint32_t dimension, float* scratch);

/// A (z - m), as generated code computes it; false where it is unknown.
bool project(const check::Projection& map, const std::vector<float>& z, std::vector<float>& y);

}  // namespace etlc::plan
