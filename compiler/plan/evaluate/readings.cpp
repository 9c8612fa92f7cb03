// The readings of a prefix monitor, interpreted: Evaluator's half that ends in a Reading.
// Takes: the values of the streams at this step. Gives: what the prefix so far, and every
// continuation of it, say.
#include <algorithm>

#include "etlmon/temporal/predicate.hpp"
#include "plan/evaluate/evaluator.hpp"

namespace etlc::plan {

using etlmon::kFalse;
using etlmon::kTop;
using etlmon::kTrue;

void Evaluator::prepare_reading(const Reading& reading, ReadingState& state) {
    if (reading.kind == Reading::Kind::pending)
        state.pending.emplace(reading.pending);
    else if (reading.kind != Reading::Kind::table)
        for (const Member& member : members_of(reading)) state.first.push_back(member.first);
}

void Evaluator::reset_reading(const Reading& reading, ReadingState& state) {
    if (reading.kind == Reading::Kind::pending) {
        state.pending->reset();
    } else if (reading.kind == Reading::Kind::table) {
        const Table& table = reading.table;
        state.registers.assign(table.ends.size(), kFalse);
        state.next = state.registers;
        state.registers[0] = kTrue;
        state.guards.assign(table.guards.size(), kTrue);
        state.weak.assign(table.weak.size() + 1, kTop);
        state.strong.assign(table.strong.size() + 1, kTop);
    } else {
        state.registers = state.first;
        state.next.assign(reading.straight.locals.size(), kFalse);
    }
}

void Evaluator::advance_readings() {
    for (std::size_t i = 0; i < plan_.readings.size(); ++i)
        readings_[i] = advance(plan_.readings[i], reading_states_[i]);
}

etlmon::Reading Evaluator::advance(const Reading& reading, ReadingState& state) const {
    const std::uint64_t position = steps_since(reading.begins_with);
    switch (reading.kind) {
        case Reading::Kind::straight: return run(reading.straight, state, position);
        case Reading::Kind::table: return run(reading.table, state);
        case Reading::Kind::pending: return state.pending->advance(position, streams_);
        case Reading::Kind::combination: break;
    }
    etlmon::Reading result = readings_[reading.operands[0]];
    for (std::uint32_t operand : reading.operands) {
        const etlmon::Reading& other = readings_[operand];
        result = reading.max ? max_of(result, other) : min_of(result, other);
    }
    return result;
}

Value Evaluator::value(const Term& term, const ReadingState& state, std::uint64_t position) const {
    const auto operand = [&](std::size_t i) { return value(term.operands[i], state, position); };
    switch (term.kind) {
        case Term::Kind::constant: return term.value;
        case Term::Kind::stream: return streams_[term.index];
        case Term::Kind::reg: return state.registers[term.index];
        case Term::Kind::local: return state.next[term.index];
        case Term::Kind::before: return operand(position < term.index ? 0 : 1);
        case Term::Kind::extreme: break;
    }
    Value result = operand(0);
    for (std::size_t i = 1; i < term.operands.size(); ++i)
        result = term.max ? max_of(result, operand(i)) : min_of(result, operand(i));
    return result;
}

etlmon::Reading Evaluator::run(const Straight& code, ReadingState& state,
                               std::uint64_t position) const {
    for (const Assignment& assignment : code.assignments) {
        const auto [low, high] = assignment.positions;
        if (position < low || (high != kUnbounded && position > high)) continue;
        const bool is_register = assignment.target == Term::Kind::reg;
        (is_register ? state.registers : state.next)[assignment.index] =
            value(assignment.value, state, position);
    }
    return {value(code.rho, state, position), value(code.lower, state, position).low,
            value(code.upper, state, position).high};
}

etlmon::Reading Evaluator::run(const Table& table, ReadingState& state) const {
    for (std::size_t g = 0; g < table.guards.size(); ++g) {
        state.guards[g] = kTrue;
        for (Slot slot : table.guards[g])
            state.guards[g] = etlmon::min_of(state.guards[g], streams_[slot]);
    }
    std::transform(table.weak.begin(), table.weak.end(), state.weak.begin() + 1,
                   [&](Slot slot) { return streams_[slot].low; });
    std::transform(table.strong.begin(), table.strong.end(), state.strong.begin() + 1,
                   [&](Slot slot) { return streams_[slot].high; });
    const auto states = static_cast<std::uint32_t>(table.ends.size());
    etlmon::machine_advance(state.registers.data(), state.next.data(), states,
                            table.transitions.data(), table.ends.data(), state.guards.data());
    std::swap(state.registers, state.next);
    return etlmon::machine_read(state.registers.data(), states, table.owed.data(),
                                state.weak.data(), state.strong.data());
}

}  // namespace etlc::plan
