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

void Evaluator::reset_reading(const Reading& reading, ReadingState& state) {
    state.registers.clear();
    if (reading.kind == Reading::Kind::pending) {
        state.pending.emplace(reading.pending);
    } else if (reading.kind == Reading::Kind::machine) {
        const Machine& machine = reading.machine;
        state.registers.assign(machine.states.size(), kFalse);
        state.next = state.registers;
        state.registers[0] = kTrue;
        state.guards.assign(machine.guards.size(), kTrue);
        state.weak.assign(machine.table.weak.size() + 1, kTop);
        state.strong.assign(machine.table.strong.size() + 1, kTop);
    } else {
        for (const Member& member : members_of(reading)) state.registers.push_back(member.first);
    }
}

void Evaluator::advance_readings() {
    for (std::size_t i = 0; i < plan_.readings.size(); ++i)
        readings_[i] = advance(plan_.readings[i], reading_states_[i]);
}

etlmon::Reading Evaluator::advance(const Reading& reading, ReadingState& state) const {
    switch (reading.kind) {
        case Reading::Kind::latch:
            if (steps_ == 0) state.registers[0] = streams_[reading.latch.operand];
            return etlmon::settled(state.registers[0]);
        case Reading::Kind::fold: return advance_fold(reading.fold, state);
        case Reading::Kind::pending: return state.pending->advance(steps_, streams_);
        case Reading::Kind::response: return advance_response(reading.response, state);
        case Reading::Kind::machine: return advance_machine(reading.machine, state);
        default: break;
    }
    etlmon::Reading result = readings_[reading.operands[0]];
    for (std::uint32_t operand : reading.operands) {
        const etlmon::Reading& other = readings_[operand];
        result = reading.max ? max_of(result, other) : min_of(result, other);
    }
    return result;
}

/// registers[0]: the max (F, U) or min (G, R) over the open window so far; registers[1]: the left
/// side before now.
etlmon::Reading Evaluator::advance_fold(const Fold& fold, ReadingState& state) const {
    const bool open =
        fold.interval.low <= steps_ && (!fold.interval.bounded() || steps_ <= fold.interval.high);
    const bool reaches_past = !fold.interval.bounded() || steps_ < fold.interval.high;
    const bool binary = fold.left != kNone;
    Value& best = state.registers[0];
    const Value guard = binary ? state.registers[1] : neutral(!fold.max);
    const Value right = streams_[fold.right];
    if (open)
        best = fold.max ? max_of(best, min_of(guard, right)) : min_of(best, max_of(guard, right));
    Value let_through = guard;
    if (binary) {
        const Value left = streams_[fold.left];
        let_through = fold.max ? min_of(guard, left) : max_of(guard, left);
        state.registers[1] = let_through;
    }
    etlmon::Reading reading = etlmon::settled(best);
    if (!reaches_past) return reading;
    const Value unseen = streams_[fold.unseen];
    if (fold.max)
        reading.upper =
            etlmon::max_of(reading.upper, etlmon::min_of(let_through.high, unseen.high));
    else
        reading.lower = etlmon::min_of(reading.lower, etlmon::max_of(let_through.low, unseen.low));
    return reading;
}

/// registers[0]: settled positions. Below, `worst` is the min of an always.
etlmon::Reading Evaluator::advance_response(const Response& response, ReadingState& state) const {
    const bool always = response.of_always;
    const auto worst = [&](Value a, Value b) { return always ? min_of(a, b) : max_of(a, b); };
    const Value hopeless = always ? kFalse : kTrue;
    Value& settled = state.registers[0];
    if (steps_ >= response.inner.high) settled = worst(settled, streams_[response.passed]);
    Value now = response.pending == kNone ? hopeless : streams_[response.pending];
    if (response.recent != kNone) now = worst(now, streams_[response.recent]);

    etlmon::Reading reading = etlmon::settled(worst(settled, now));
    const Value answer = streams_[response.unseen_answer];
    const Value body = streams_[response.unseen_body];
    const bool reaches_past = !response.outer.bounded() || steps_ < response.outer.high;
    if (always) {
        reading.upper = etlmon::min_of(settled.high, etlmon::max_of(now.high, answer.high));
        if (reaches_past) reading.lower = etlmon::min_of(reading.lower, body.low);
    } else {
        reading.lower = etlmon::max_of(settled.low, etlmon::min_of(now.low, answer.low));
        if (reaches_past) reading.upper = etlmon::max_of(reading.upper, body.high);
    }
    return reading;
}

etlmon::Reading Evaluator::advance_machine(const Machine& machine, ReadingState& state) const {
    const auto low = [&](Slot slot) { return streams_[slot].low; };
    const auto high = [&](Slot slot) { return streams_[slot].high; };
    const Table& table = machine.table;
    for (std::size_t g = 0; g < machine.guards.size(); ++g) {
        state.guards[g] = kTrue;
        for (Slot slot : machine.guards[g])
            state.guards[g] = etlmon::min_of(state.guards[g], streams_[slot]);
    }
    std::transform(table.weak.begin(), table.weak.end(), state.weak.begin() + 1, low);
    std::transform(table.strong.begin(), table.strong.end(), state.strong.begin() + 1, high);

    const auto states = static_cast<std::uint32_t>(machine.states.size());
    etlmon::machine_advance(state.registers.data(), state.next.data(), states,
                            table.transitions.data(), table.ends.data(), state.guards.data());
    std::swap(state.registers, state.next);
    return etlmon::machine_read(state.registers.data(), states, table.owed.data(),
                                state.weak.data(), state.strong.data());
}

}  // namespace etlc::plan
