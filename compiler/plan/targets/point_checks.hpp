// Decides what a step checks about an embedding before it calls kernels, and what the kernels
// check: whether the point is present and finite, and its length. Nothing is checked twice where a
// kernel sees it anyway.
#pragma once

#include "plan/program/program.hpp"

namespace etlc::plan {

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
