// What a step has to find out about an embedding before kernels are called with it, and what they
// find out themselves. Takes: a plan. Gives: who looks whether a point is there and finite, and who
// finds its length. Keeps true: nothing is looked at twice where a kernel can see it in what it
// computes anyway.
#pragma once

#include "plan/program/program.hpp"

namespace etlc::plan {

/// The projected points that distances are measured from, and those that these are projected from
/// in turn, ascending: each behind its inner one.
std::vector<Index> projected_points(const check::Model& model, const std::vector<Index>& distances);

/// The distance's kernel finds out by itself whether all elements of the point are finite: one that
/// measures every row as it stands in the header. Others are called where they are.
bool checks_point(const Plan& plan, Index distance);

/// All kernels that an embedding goes to do; where it is held, step() has to know before.
bool left_to_kernels(const Plan& plan, Index embedding);

/// Several distances need the length of this embedding, on every step.
bool shares_direction(const Plan& plan, Index embedding);

}  // namespace etlc::plan
