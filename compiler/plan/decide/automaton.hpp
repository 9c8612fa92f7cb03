// Builds weighted automata over (max, min), the general method for future formulas. A state is a
// set of obligations: temporal formulas that must hold from the next position. With v'[T] = max
// over transitions S -> T of min(v[S], guard), starting from v[initial] = +inf, the greatest v[S]
// over the states without strong obligations is rho(f, 0, i) on every prefix.
//
// A formula expands, at a position, into a disjunction of (literals now, obligations next): F f is
// "f now, or F f next", G f is "f now, and G f next", U and R likewise, and windows count down.
// Sub-formulas without future are literals, which are streams. A clause is dropped if its literals
// and obligations imply another's. p && !p stays: its value is -|p|.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "ir/graph.hpp"
#include "plan/decide/streams.hpp"
#include "plan/program/reading.hpp"

namespace etlc::plan {

struct Transition {
    std::uint32_t source = 0;
    std::uint32_t target = 0;
    std::uint32_t guard = 0;
};

struct Automaton {
    /// The obligations of each state, sorted; state 0 is the formula before the first step.
    std::vector<std::vector<ir::NodeId>> states;
    /// The literals of each guard, which is their min; guard 0 is empty: true.
    std::vector<std::vector<ir::NodeId>> guards;
    std::vector<Transition> transitions;  ///< by target, guard, source
};

/// Returns whether the operator still requires something to come, as F and U do; G and R only
/// forbid.
bool is_strong(ir::Op op);

/// The limits of a construction.
struct AutomatonLimits {
    std::size_t states = 65536;
    std::size_t transitions = 65536;
    std::uint64_t work = std::uint64_t{1} << 28U;  ///< steps of loops over literals and obligations
};

/// The literals of a construction: formulas without future, or all with a bounded future.
enum class Literals : std::uint8_t { without_future, with_bounded_future };

/// The size that a construction reached.
struct AutomatonSize {
    std::size_t states = 0;
    std::size_t transitions = 0;
    std::uint64_t work = 0;    ///< work done
    bool out_of_work = false;  ///< stopped by the limit of work, not of size
};
/// Returns the automaton, or nothing where it would exceed the limits; sets `reached`.
std::optional<Automaton> build_automaton(ir::Graph& graph, ir::NodeId formula, Literals literals,
                                         const AutomatonLimits& limits, AutomatonSize& reached);

// State machines made from automata: straight-line code for small ones, tables of
// etlmon/temporal/machine.hpp for larger ones. Both compute the same registers from the same
// streams.

struct Machine {
    struct State {
        bool strong = false;       ///< has an open F or U
        bool always_true = false;  ///< its register never leaves +inf and is not kept
        /// Lowest unseen value of its obligations if all are weak; else kNone.
        Slot weak_unseen = kNone;
        Slot strong_unseen = kNone;  ///< highest unseen value of its strong obligations
    };
    Automaton automaton;
    std::vector<State> states;
    /// Per guard of the automaton, its literals: streams, or parts of a pending reading.
    std::vector<std::vector<std::uint32_t>> guards;
};

/// Larger machines become a constant table and one loop.
inline constexpr std::size_t kMaxUnrolledStates = 32;
inline constexpr std::size_t kMaxUnrolledTransitions = 160;

/// Returns whether straight-line code is used.
bool is_small(const Machine& machine);

Table make_table(const Machine& machine);

/// Returns the code that updates and reads the registers.
Straight straight_line(const Machine& machine, const StreamBuilder& streams);

}  // namespace etlc::plan
