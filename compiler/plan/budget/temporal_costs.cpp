// The costs of streams and readings, the temporal half of a step.
#include <bit>

#include "etlmon/hosted/footprint.hpp"
#include "plan/budget/budget.hpp"
#include "plan/program/value_type.hpp"

namespace etlc::plan {

namespace {

using check::Values;

/// Costs of `combined` minima or maxima of two, and `kept` values.
Cost values(std::uint64_t kept, std::uint64_t combined) {
    return {.code_bytes = (kept + combined) * kCodePerValueOperation,
            .operations = combined * kKeysPerValue};
}

/// Costs of a window in order: both ends of a value are searched for and exchanged, which moves up
/// to all others. One that keeps the n greatest values merges two lists, on the stack, for each
/// combination.
Cost count_cost(std::uint32_t n, std::uint32_t length, const ValueType& of) {
    if (of.on_demand) return {.code_bytes = kCodePerRing, .operations = 4};
    const std::uint64_t compared = 2 * std::bit_width(length) + 2;
    if (etlmon::keeps_order(n, length))
        return {.code_bytes = 2 * kCodePerWindow,
                .operations = kKeysPerValue * (compared + length) + kPartingComparisons};
    const std::uint64_t combined = std::uint64_t{n} * etlmon::window_operations(length);
    return {.stack_bytes = kListsOnStack * n * of.value,
            .code_bytes = 2 * kCodePerWindow,
            .operations = combined * kKeysPerValue + kPartingComparisons};
}

Cost window_cost(std::uint32_t length, std::uint64_t sides) {
    if (length == 1) return {};
    const std::uint64_t combined = etlmon::window_operations(length) * (2 * sides - 1);
    return {.code_bytes = kCodePerWindow * sides,
            .operations = combined * kKeysPerValue + kPartingComparisons};
}

/// Costs of the assignments and the reading of straight-line code; a bound takes one end of values.
Cost straight_cost(const Straight& code) {
    std::uint64_t combined = combinations(code.rho);
    std::uint64_t comparisons = asks_position(code.lower) + asks_position(code.upper);
    for (const Assignment& assignment : code.assignments) {
        combined += combinations(assignment.value);
        comparisons += assignment.positions.low > 0;
        comparisons += assignment.positions.bounded();
    }
    const std::uint64_t ends = combinations(code.lower) + combinations(code.upper);
    Cost cost = values(code.assignments.size(), combined);
    cost.operations += ends + comparisons;
    cost.code_bytes += kCodePerReading + (ends + comparisons) * kCodePerEnd;
    return cost;
}

/// Operations of a window at one position: a suffix, a prefix, and combining both into the result.
constexpr std::uint64_t kPendingWindow = 4;

/// Returns operations on values or readings at one position, in units of the temporal loops of
/// etlmon/temporal/pending.hpp.
std::uint64_t pending_steps(const Pending& pending) {
    std::uint64_t steps = 0;
    for (const Pending::Part& part : pending.parts) {
        const bool temporal = part.unseen != kNone;
        const bool is_binary = part.operands.size() == 2;
        if (part.leaf != kNone) continue;
        steps += temporal ? kPendingWindow : part.operands.size() - 1;
        if (temporal && is_binary) steps += 3 + (part.interval.low > 0 ? kPendingWindow : 0);
    }
    if (pending.is_fold) return steps + 4;
    steps += 2 * pending.table.ends.size() + 2 * pending.table.transitions.size();
    for (const auto& guard : pending.table.guards) steps += guard.size();
    return steps;
}

Cost pending_cost(const Pending& pending, const ValueType& of) {
    constexpr std::uint64_t kKeysPerReading = 4;
    const std::uint64_t positions = pending.horizon + std::uint64_t{1};
    Cost cost;
    cost.stack_bytes = pending.parts.size() * positions * of.reading;
    cost.operations = positions * pending_steps(pending) * kKeysPerReading;
    cost.code_bytes = pending.parts.size() * kCodePerWindow + kCodePerTable;
    if (pending.is_fold) return cost;
    const std::size_t states = pending.table.ends.size();
    const std::size_t guards = pending.table.guards.size();
    // the guards at each position, and the scratch of PendingMachine::read
    cost.stack_bytes +=
        (guards * positions + 2 * states) * of.reading + (guards + states) * of.value;
    cost.code_bytes += pending.table.transitions.size() * kTransitionBytes + states * kStateBytes +
                       guards * kCodePerValueOperation;
    return cost;
}

Cost table_cost(std::size_t states, std::size_t transitions) {
    return {.code_bytes = kCodePerTable + transitions * kTransitionBytes + states * kStateBytes,
            .operations = (3 * states + 2 * transitions) * kKeysPerValue};
}

Cost table_cost(const Table& table) {
    Cost cost = table_cost(table.ends.size(), table.transitions.size());
    cost.code_bytes += table.guards.size() * kCodePerValueOperation;
    for (const auto& guard : table.guards)
        cost.operations += guard.empty() ? 0 : (guard.size() - 1) * kKeysPerValue;
    return cost;
}

/// Returns code and work of a stream.
Cost work_of(const Stream& stream, Values kind) {
    switch (stream.op) {
        case StreamOp::constant:
        case StreamOp::predicate:
        case StreamOp::flag:
        case StreamOp::negation: return {.code_bytes = kCodePerValueOperation};
        case StreamOp::combination: return values(0, stream.operands.size() - 1);
        case StreamOp::within: return {.code_bytes = kCodePerValueOperation, .operations = 2};
        case StreamOp::delay:
        case StreamOp::shift: return {.code_bytes = kCodePerRing};
        case StreamOp::running: return values(1, 1);
        case StreamOp::since: return values(1, 2);
        case StreamOp::window: return window_cost(stream.length, 1);
        case StreamOp::window_since:
        case StreamOp::window_until: return window_cost(stream.length, 2);
        case StreamOp::window_count:
            return count_cost(stream.index, stream.length, value_type(kind));
        case StreamOp::window_handover: return window_cost(stream.length, 3);
        case StreamOp::widening: return Cost{.code_bytes = kCodePerRing} + values(0, 1);
    }
    return {};
}

/// Returns code, work and stack of a reading.
Cost work_of(const Reading& reading, Values kind) {
    switch (reading.kind) {
        case Reading::Kind::straight: return straight_cost(reading.straight);
        case Reading::Kind::table: return table_cost(reading.table);
        case Reading::Kind::pending: return pending_cost(reading.pending, value_type(kind));
        case Reading::Kind::combination: return values(0, 2 * (reading.operands.size() - 1));
    }
    return {};
}

/// Adds the bytes of these members.
Cost keeping(Cost cost, const std::vector<Member>& members, Values kind) {
    for (const Member& member : members) cost.state_bytes += bytes_of(member, kind);
    return cost;
}

}  // namespace

Cost cost_of(const Stream& stream, Values kind) {
    return keeping(work_of(stream, kind), members_of(stream), kind);
}

Cost cost_of(const Reading& reading, Values kind) {
    return keeping(work_of(reading, kind), members_of(reading), kind);
}

Cost cost_of_table(std::size_t states, std::size_t transitions, Values kind) {
    const Member table{.kind = Member::Kind::machine, .length = static_cast<std::uint32_t>(states)};
    return keeping(table_cost(states, transitions), {table}, kind);
}

}  // namespace etlc::plan
