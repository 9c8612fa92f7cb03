// State machines made from automata: straight-line code for small ones, tables of
// etlmon/temporal/machine.hpp for larger ones. Both compute the same registers from the same
// streams.
#pragma once

#include <vector>

#include "plan/decide/automaton.hpp"
#include "plan/decide/streams.hpp"
#include "plan/program/reading.hpp"

namespace etlc::plan {

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
