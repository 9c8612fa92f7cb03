// A state machine as it is run: from registers, through literals, to registers.
// Takes: an automaton, its guards as streams. Gives: the straight-line program of a small one, and
// the tables of etlmon/machine.hpp, which the evaluator runs and a larger one is emitted as. Keeps
// true: both make the same registers of the same streams.
#pragma once

#include <cstdint>
#include <vector>

#include "etlmon/temporal/machine.hpp"
#include "plan/decide/automaton.hpp"

namespace etlc::plan {

using check::kNone;
using Slot = std::uint32_t;  ///< index of a stream

/// A register as an update reads it.
struct Source {
    std::uint32_t state = 0;
    bool updated = false;  ///< this step's value, else that of the step before

    bool operator==(const Source&) const = default;
};

/// min(max of the sources, literals); without sources the literals alone: a source that is always
/// true adds nothing.
struct Term {
    std::vector<Source> sources;
    std::vector<Slot> literals;
};

struct Update {
    std::uint32_t state = 0;
    std::vector<Term> terms;  ///< none: the register becomes false
};

/// Straight-line code: each update a max of terms, in this order.
///
/// Where every way into S followed by the guard h is also a way into T, those ways are one: min(S
/// after its update, h). So F (a && F b) is S = max(S, a); T = max(T, min(S, b)): a chain where the
/// transitions alone give a triangle.
struct RegisterProgram {
    std::vector<Update> updates;
    /// No update reads the old value of a register that an earlier one has written: no copies are
    /// needed.
    bool in_place = false;
};

/// Constant tables, and which streams fill the lists of keys at each step.
struct Table {
    std::vector<etlmon::Transition> transitions;
    std::vector<std::uint32_t> ends;  ///< per state
    std::vector<etlmon::Owed> owed;   ///< per state
    /// Streams whose low ends are the weak keys, and whose high ends are the strong keys, from
    /// index 1 on; index 0 is kTop.
    std::vector<Slot> weak;
    std::vector<Slot> strong;
};

struct Machine {
    struct State {
        bool strong = false;       ///< owes an F or U
        bool always_true = false;  ///< its register never leaves +inf and is not kept
        /// Lowest unseen value of what it owes, weakly all of it; else kNone.
        Slot weak_unseen = kNone;
        Slot strong_unseen = kNone;  ///< highest unseen value of what it owes strongly
    };
    Automaton automaton;
    std::vector<State> states;
    std::vector<std::vector<Slot>> guards;  ///< per guard of the automaton, its literals as streams

    bool unrolled = false;    ///< small enough for straight-line code
    RegisterProgram program;  ///< where it is unrolled
    Table table;

    /// Of an unrolled machine: which of the kept registers is a state's; only the first state can
    /// be always true.
    std::size_t register_of(std::uint32_t state) const {
        return state - (states[0].always_true ? 1 : 0);
    }
};

/// Fills in how the machine is run, from its automaton, states and guards.
void complete(Machine& machine);

/// From its automaton and states alone.
Table make_table(const Machine& machine);

RegisterProgram make_register_program(const Machine& machine);

/// Minima and maxima of values that it performs.
std::size_t operations(const RegisterProgram& program);

}  // namespace etlc::plan
