// State machines: from what a formula owes to code that steps.
// Takes: an automaton, its guards as streams. Gives: the straight-line code of a small one, and the
// tables of etlmon/temporal/machine.hpp that a larger one is. Keeps true: both make the same
// registers of the same streams.
#pragma once

#include <vector>

#include "plan/decide/automaton.hpp"
#include "plan/decide/streams.hpp"
#include "plan/program/reading.hpp"

namespace etlc::plan {

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
    /// Per guard of the automaton, its literals: streams, or parts of a pending reading.
    std::vector<std::vector<std::uint32_t>> guards;
};

/// Small enough for straight-line code.
bool is_small(const Machine& machine);

Table make_table(const Machine& machine);

/// The registers of its states, each updated by the ways that lead into it.
Straight straight_line(const Machine& machine, const StreamBuilder& streams);

}  // namespace etlc::plan
