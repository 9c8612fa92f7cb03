// How far formulas look ahead and back.
// Takes: the formulas of the model. Gives: horizons, and where the operators stand that a kind of
// monitor cannot bear. Keeps true: one pass in topological order; a horizon is the sum of the upper
// bounds along the deepest path as written.
#pragma once

#include <limits>
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

/// What a missing sample may do to the verdicts of a monitor, at worst; another sample may decide
/// the verdict earlier.
struct Gap {
    static constexpr std::uint64_t kForGood = std::numeric_limits<std::uint64_t>::max();

    /// Those that stand for nothing where they are missing (`missing false`); empty: the monitor
    /// is never unknown.
    std::vector<Index> inputs;
    std::uint64_t steps = 0;  ///< of unknown verdicts; kForGood
};

/// Parallel to model.monitors.
std::vector<Gap> gaps(const Model& model);

}  // namespace etlc::check
