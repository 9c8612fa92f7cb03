// Calls the runtime's kernels for distances of the model. Rows are prepared in double and in fixed
// order, so every machine gets the same constants; the kernels are compiled only here.
#pragma once

#include <string>
#include <vector>

#include "check/model/model.hpp"
#include "etlmon/distance/aggregate.hpp"
#include "etlmon/hosted/table.hpp"
#include "plan/program/program.hpp"

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

// Decides what a step checks about an embedding before it calls kernels, and what the kernels
// check: whether the point is present and finite, and its length. Nothing is checked twice where a
// kernel sees it anyway.

/// Returns the points that distances are measured from, and those that these are made of,
/// ascending: each after its parts.
std::vector<Index> points_of(const check::Model& model, const std::vector<Index>& distances);
/// Returns those that are projected.
std::vector<Index> projected_points(const check::Model& model, const std::vector<Index>& distances);
/// Returns those whose elements a step has to compute or to look up, before it measures anything:
/// all but embeddings, and vectors of scalars that are only compared with target sets.
std::vector<Index> built_points(const check::Model& model, const std::vector<Index>& distances);

/// The samples of a point that are kept: of the last `steps` steps.
struct EarlierPoint {
    Index point = 0;
    std::uint32_t steps = 0;
};
/// Returns what the delayed ones among the points need, by point.
std::vector<EarlierPoint> earlier_points(const check::Model& model,
                                         const std::vector<Index>& distances);
/// Returns the bytes of an element of a point as it is kept.
std::uint64_t earlier_element_bytes(const check::Model& model, Index point);

/// Returns whether the distance's kernel checks that all elements of the point are finite: one that
/// measures every row in the header. Others are called only where they are.
bool checks_point(const Plan& plan, Index distance);

/// Returns whether all kernels of an embedding check it; with `hold` or `stale after`, step() has
/// to check first.
bool left_to_kernels(const Plan& plan, Index embedding);

/// Returns whether several distances need the length of this embedding at every step.
bool shares_direction(const Plan& plan, Index embedding);

}  // namespace etlc::plan
