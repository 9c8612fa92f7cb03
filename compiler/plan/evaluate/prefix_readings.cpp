// The part of Evaluator that interprets the readings of prefix monitors.
#include <algorithm>
#include <limits>

#include "etlmon/temporal/predicate.hpp"
#include "plan/evaluate/evaluator.hpp"

namespace etlc::plan {

using etlmon::kFalse;
using etlmon::kTop;
using etlmon::kTrue;

void Evaluator::advance_readings() {
    for (std::size_t i = 0; i < plan_.readings.size(); ++i)
        readings_[i] = advance(plan_.readings[i], state_->readings[i]);
}

etlmon::Reading Evaluator::advance(const Reading& reading, State::OfReading& state) const {
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

Value Evaluator::value(const Term& term, const State::OfReading& state,
                       std::uint64_t position) const {
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

etlmon::Reading Evaluator::run(const Straight& code, State::OfReading& state,
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

etlmon::Reading Evaluator::run(const Table& table, State::OfReading& state) const {
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

// ---- the last positions, again at every step
// -----------------------------------------------------

PendingEvaluator::PendingEvaluator(const Pending& pending) : pending_(&pending) {
    leaves_.resize(pending.parts.size());
    const std::size_t positions = pending.horizon + std::size_t{1};
    for (auto& leaf : leaves_) leaf.reserve(positions);
    parts_.assign(pending.parts.size(), Readings(positions));
    if (!pending.is_fold) {
        const Table& table = pending.table;
        guards_.resize(positions * table.guards.size());
        weak_.assign(table.weak.size() + 1, etlmon::kTop);
        strong_.assign(table.strong.size() + 1, etlmon::kTop);
        scratch_.resize(2 * table.ends.size());
        values_.resize(table.guards.size() + table.ends.size());
    }
    reset();
}

void PendingEvaluator::reset() {
    for (auto& leaf : leaves_) leaf.clear();
    if (pending_->is_fold) {
        registers_.resize(2);
        registers_[0] = neutral(pending_->fold.max);
        registers_[1] = neutral(!pending_->fold.max);
    } else {
        registers_.assign(pending_->table.ends.size(), kFalse);
        registers_[0] = kTrue;
    }
}

bool PendingEvaluator::fits() const {
    return std::all_of(leaves_.begin(), leaves_.end(), [&](const std::vector<Value>& leaf) {
        return leaf.size() <= pending_->horizon + std::size_t{1};
    });
}

etlmon::Reading PendingEvaluator::advance(std::uint64_t position,
                                          const std::vector<Value>& streams) {
    // The counter saturates as in generated code.
    const auto step = static_cast<std::uint32_t>(
        std::min<std::uint64_t>(position, std::numeric_limits<std::uint32_t>::max()));
    const std::uint32_t count = std::min(step, pending_->horizon) + 1;
    evaluate_parts(count, streams);
    return pending_->is_fold ? advance_fold(step, count, streams)
                             : advance_machine(step, count, streams);
}

void PendingEvaluator::evaluate_parts(std::uint32_t count, const std::vector<Value>& streams) {
    for (std::size_t i = 0; i < pending_->parts.size(); ++i) evaluate_part(i, count, streams);
}

void PendingEvaluator::evaluate_part(std::size_t index, std::uint32_t count,
                                     const std::vector<Value>& streams) {
    const Pending::Part& part = pending_->parts[index];
    Readings& out = parts_[index];
    if (part.leaf != kNone) {
        auto& leaf = leaves_[index];
        if (leaf.size() > pending_->horizon) leaf.erase(leaf.begin());
        leaf.push_back(streams[part.leaf]);
        std::transform(leaf.begin(), leaf.end(), out.begin(),
                       [](Value value) { return etlmon::settled(value); });
        return;
    }
    if (part.unseen == kNone) {
        out = parts_[part.operands[0]];
        for (std::size_t i = 1; i < part.operands.size(); ++i) {
            const Readings& other = parts_[part.operands[i]];
            if (!part.max)
                etlmon::pending_and(out.data(), other.data(), out.data(), count);
            else
                etlmon::pending_or(out.data(), other.data(), out.data(), count);
        }
        return;
    }
    const etlmon::Reading* left =
        part.operands.size() == 2 ? parts_[part.operands[0]].data() : nullptr;
    const etlmon::Reading* right = parts_[part.operands.back()].data();
    const auto [low, high] = part.interval;
    if (part.max)
        etlmon::pending_at_each<etlmon::Seeking>(left, right, out.data(), count, low, high,
                                                 streams[part.unseen].high);
    else
        etlmon::pending_at_each<etlmon::Guarding>(left, right, out.data(), count, low, high,
                                                  streams[part.unseen].low);
}

etlmon::Reading PendingEvaluator::advance_fold(std::uint32_t step, std::uint32_t count,
                                               const std::vector<Value>& streams) {
    const Pending::Part& fold = pending_->fold;
    const etlmon::Reading* left =
        fold.operands.size() == 2 ? parts_[fold.operands[0]].data() : nullptr;
    const etlmon::Reading* right = parts_[fold.operands.back()].data();
    const auto [low, high] = fold.interval;
    if (fold.max)
        return etlmon::pending_from_start<etlmon::Seeking>(registers_[0], registers_[1], left,
                                                           right, count, step, pending_->horizon,
                                                           low, high, streams[fold.unseen].high);
    return etlmon::pending_from_start<etlmon::Guarding>(registers_[0], registers_[1], left, right,
                                                        count, step, pending_->horizon, low, high,
                                                        streams[fold.unseen].low);
}

etlmon::Reading PendingEvaluator::advance_machine(std::uint32_t step, std::uint32_t count,
                                                  const std::vector<Value>& streams) {
    const Table& table = pending_->table;
    const std::size_t width = table.guards.size();
    std::fill(guards_.begin(), guards_.end(), etlmon::settled(kTrue));
    for (std::uint32_t p = 0; p < count; ++p)
        for (std::size_t g = 0; g < width; ++g)
            for (std::uint32_t part : table.guards[g])
                guards_[p * width + g] = min_of(guards_[p * width + g], parts_[part][p]);
    std::transform(table.weak.begin(), table.weak.end(), weak_.begin() + 1,
                   [&](Slot slot) { return streams[slot].low; });
    std::transform(table.strong.begin(), table.strong.end(), strong_.begin() + 1,
                   [&](Slot slot) { return streams[slot].high; });
    const std::size_t states = registers_.size();
    return etlmon::pending_machine(registers_.data(), static_cast<std::uint32_t>(states),
                                   guards_.data(), static_cast<std::uint32_t>(width), count,
                                   step >= pending_->horizon, table.transitions.data(),
                                   table.ends.data(), table.owed.data(), weak_.data(),
                                   strong_.data(), scratch_.data(), values_.data());
}

}  // namespace etlc::plan
