// The general method for future formulas: a weighted automaton over (max, min).
// Takes: a formula in negation normal form. Gives: states, each a set of obligations (temporal
// formulas that must hold from the next position), and guarded transitions. Keeps true: with v'[T]
// = max over transitions S -> T of min(v[S], guard), starting from v[initial] = +inf, the greatest
// v[S] over the states that owe nothing strongly is rho(f, 0, i) on every prefix.
//
// A formula expands, at a position, into a disjunction of (literals now, obligations next): F f is
// "f now, or F f next", G f is "f now, and G f next", U and R alike, windows count down.
// Sub-formulas without future are literals: they stream. A clause that another makes idle goes: its
// literals and obligations imply the other's. p && !p stays: its value is -|p|.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "ir/graph.hpp"

namespace etlc::plan {

struct Transition {
    std::uint32_t source = 0;
    std::uint32_t target = 0;
    std::uint32_t guard = 0;
};

struct Automaton {
    /// Obligations, sorted; state 0 is the formula before the first step.
    std::vector<std::vector<ir::NodeId>> states;
    /// Literals whose min is the guard; guard 0 is empty: true.
    std::vector<std::vector<ir::NodeId>> guards;
    std::vector<Transition> transitions;  ///< by target, guard, source
};

/// F and U owe something that must still come; G and R only forbid.
bool is_strong(ir::Op op);

/// Size up to which a construction goes on.
struct AutomatonLimits {
    std::size_t states = 65536;
    std::size_t transitions = 65536;
    std::uint64_t work = std::uint64_t{1} << 28U;  ///< steps of loops over literals and obligations
};

/// What the construction takes as a literal: formulas without future, or all whose future is
/// bounded.
enum class Literals : std::uint8_t { without_future, with_bounded_future };

/// The automaton, or nothing where it would be larger than the limits; `reached` then tells how far
/// it came.
struct AutomatonSize {
    std::size_t states = 0;
    std::size_t transitions = 0;
    std::uint64_t work = 0;    ///< that it took
    bool out_of_work = false;  ///< which ended it, before its size did
};
std::optional<Automaton> build_automaton(ir::Graph& graph, ir::NodeId formula, Literals literals,
                                         const AutomatonLimits& limits, AutomatonSize& reached);

}  // namespace etlc::plan
