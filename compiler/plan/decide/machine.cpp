#include "plan/decide/machine.hpp"

#include <algorithm>

namespace etlc::plan {

namespace {

/// Returns the index of a stream's key in its list; 0, the neutral key, for no stream.
std::uint16_t index_of(std::vector<Slot>& list, Slot slot) {
    if (slot == kNone) return 0;
    const auto found = std::find(list.begin(), list.end(), slot);
    const auto index = static_cast<std::uint16_t>(found - list.begin() + 1);
    if (found == list.end()) list.push_back(slot);
    return index;
}

}  // namespace

Table make_table(const Machine& machine) {
    Table table;
    table.ends.assign(machine.states.size(), 0);
    for (const Transition& t : machine.automaton.transitions) {  // sorted by target
        table.transitions.push_back(
            {static_cast<std::uint16_t>(t.source), static_cast<std::uint16_t>(t.guard)});
        table.ends[t.target] = static_cast<std::uint32_t>(table.transitions.size());
    }
    for (std::size_t q = 1; q < table.ends.size(); ++q)
        table.ends[q] = std::max(table.ends[q], table.ends[q - 1]);
    for (const Machine::State& state : machine.states) {
        const std::uint16_t weak =
            state.strong ? etlmon::kStrongly : index_of(table.weak, state.weak_unseen);
        table.owed.push_back({weak, index_of(table.strong, state.strong_unseen)});
    }
    table.guards = machine.guards;
    table.obligations = machine.automaton.states;
    return table;
}

bool is_small(const Machine& machine) {
    return machine.states.size() <= kMaxUnrolledStates &&
           machine.automaton.transitions.size() <= kMaxUnrolledTransitions;
}

}  // namespace etlc::plan
