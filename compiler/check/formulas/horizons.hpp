// Measures how far formulas look ahead and back, and finds operators that a kind of monitor does
// not support. A horizon is the sum of the upper bounds on the deepest path as written.
#pragma once

#include <cstdint>
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

/// The first positions from which on a formula can be satisfied and can be violated, although a
/// predicate is unknown until the trace has the past that it reads.
struct Decidable {
    static constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();

    std::uint64_t satisfied = 0;
    std::uint64_t violated = 0;

    std::uint64_t position(bool of_satisfied) const { return of_satisfied ? satisfied : violated; }
};

/// Verdicts as of some later step, or those that stay.
enum class Lasts : std::uint8_t { so_far, for_good };

/// Parallel to model.formulas. Without `reads_past` the predicates read the present only. Verdicts
/// that only step 0 can bring, as that of p U q by q, do not count: a formula that depends on them
/// is hardly meant.
std::vector<Decidable> decidable(const Model& model, Lasts lasts, bool reads_past);

/// Returns how many steps back a formula reads; Gap::kForGood without a limit.
std::uint64_t steps_read_back(const Model& model, Index formula);

/// Returns how many steps of past a predicate needs to be known: none where its range decides it.
std::uint64_t past_needed(const Model& model, const Predicate& predicate);

// Finds formulas whose verdict does not depend on the inputs, where predicates may have any value.
// A constant formula has robustness +inf or -inf at every position of every prefix.

enum class Constancy : std::uint8_t { varies, always, never };

struct Constancies {
    Constancy anywhere = Constancy::varies;  ///< at every position
    Constancy at_start = Constancy::varies;  ///< at position 0, which has no past
};

/// Parallel to model.formulas.
std::vector<Constancies> constancies(const Model& model);

}  // namespace etlc::check
