// Decides what a step checks about an embedding before it calls kernels, and what the kernels
// check: whether the point is present and finite, and its length. Nothing is checked twice where a
// kernel sees it anyway.
#pragma once

#include "plan/program/program.hpp"

namespace etlc::plan {

/// Returns the projected points that distances are measured from, and those on the way, ascending:
/// each after its inner one.
std::vector<Index> projected_points(const check::Model& model, const std::vector<Index>& distances);

/// Returns whether the distance's kernel checks that all elements of the point are finite: one that
/// measures every row in the header. Others are called only where they are.
bool checks_point(const Plan& plan, Index distance);

/// Returns whether all kernels of an embedding check it; with `hold` or `stale after`, step() has
/// to check first.
bool left_to_kernels(const Plan& plan, Index embedding);

/// Returns whether several distances need the length of this embedding at every step.
bool shares_direction(const Plan& plan, Index embedding);

}  // namespace etlc::plan
