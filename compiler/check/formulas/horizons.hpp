// Measures how far formulas look ahead and back, and finds operators that a kind of monitor does
// not support. A horizon is the sum of the upper bounds on the deepest path as written.
#pragma once

#include <limits>
#include <vector>

#include "check/model/model.hpp"

namespace etlc::check {

struct Reach {
    std::uint64_t horizon = 0;       ///< in steps; saturates far above kMaxBound
    Index future = kNone;            ///< a node of the formula that looks ahead
    Index unbounded = kNone;         ///< a node that looks ahead without bound
    Index past_over_future = kNone;  ///< a node that looks back over an operand that looks ahead
};

/// Parallel to model.formulas.
std::vector<Reach> reaches(const Model& model);

/// The worst effect of a missing sample on the verdicts of a monitor; another sample may decide the
/// verdict earlier.
struct Gap {
    static constexpr std::uint64_t kForGood = std::numeric_limits<std::uint64_t>::max();

    /// Inputs without a value for missing samples (`missing false`); if empty, the monitor is never
    /// unknown.
    std::vector<Index> inputs;
    std::uint64_t steps = 0;  ///< with unknown verdicts; kForGood
};

/// Parallel to model.monitors.
std::vector<Gap> gaps(const Model& model);

}  // namespace etlc::check
