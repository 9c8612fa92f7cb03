// How far formulas look ahead and back.
// Takes: the formulas of the model. Gives: horizons, and where the operators stand that a kind of
// monitor cannot bear. Keeps true: one pass in topological order; a horizon is the sum of the upper
// bounds along the deepest path as written.
#pragma once

#include <vector>

#include "check/model/model.hpp"

namespace etlc::check {

struct Reach {
    std::uint64_t horizon = 0;       ///< steps; saturates far above kMaxBound
    Index future = kNone;            ///< a node that looks ahead, in the formula or at its top
    Index unbounded = kNone;         ///< one that looks ahead without bound
    Index past_over_future = kNone;  ///< one that looks back over an operand that looks ahead
};

/// Parallel to model.formulas.
std::vector<Reach> reaches(const Model& model);

}  // namespace etlc::check
