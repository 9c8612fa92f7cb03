#include "plan/budget/budget.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "etlmon/hosted/footprint.hpp"
#include "etlmon/past/numbers.hpp"
#include "etlmon/past/points.hpp"
#include "plan/program/sample_codes.hpp"
#include "plan/program/value_type.hpp"
#include "plan/targets/point_checks.hpp"
#include "plan/targets/stored.hpp"

namespace etlc::plan {

namespace {

using check::Values;

constexpr std::uint64_t kWord = sizeof(std::uint32_t);
constexpr std::uint64_t kKeysPerValue = 2;
/// For a window whose highs and lows differ: finding the blocks with highs of their own
/// (etlmon::Parting).
constexpr std::uint64_t kPartingComparisons = 6;
constexpr std::uint64_t kListsOnStack = 6;

// Estimated code, measured on x86-64 and Cortex-M4 at -O2 and -Os and rounded up.
constexpr std::uint64_t kCodePerValueOperation = 24;
constexpr std::uint64_t kCodePerEnd = 16;
constexpr std::uint64_t kCodePerReading = 64;
constexpr std::uint64_t kCodePerWindow = 240;
constexpr std::uint64_t kCodePerRing = 64;
constexpr std::uint64_t kCodePerMean = 1200;       // of which all means share the most
constexpr std::uint64_t kCodePerAdaptation = 144;  // observe_P() on a Cortex-M4 at -Os
constexpr std::uint64_t kCodePerTable = 200;
constexpr std::uint64_t kCodePerSamples = 600;
constexpr std::uint64_t kTransitionBytes = sizeof(etlmon::Transition);
constexpr std::uint64_t kStateBytes = sizeof(std::uint32_t) + sizeof(etlmon::Obligations);

/// Costs of `combined` minima or maxima of two, and `kept` values.
Cost values(std::uint64_t kept, std::uint64_t combined) {
    return {.code_bytes = (kept + combined) * kCodePerValueOperation,
            .operations = combined * kKeysPerValue};
}

/// Costs of a window that keeps the n greatest values: each combination merges two lists, on the
/// stack.
Cost count_cost(std::uint32_t n, std::uint32_t length, const ValueType& of) {
    const std::uint64_t combined = std::uint64_t{n} * etlmon::window_operations(length);
    if (of.on_demand) return {.code_bytes = kCodePerRing, .operations = 4};
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

Cost distance_cost(const check::Model& model, const check::Distance& distance) {
    const std::uint32_t dimension = model.points[distance.point].dimension;
    const bool between = distance.is_between_points();
    const std::uint64_t rows = between ? 1 : model.targets[distance.target].rows;
    const std::uint64_t elements = rows * dimension;
    // Between points, cosine and angular scale the second one to length 1.
    const bool scales = between && check::is_of_directions(distance.metric);
    return {.stack_bytes = scales ? dimension * kWord : 0,
            .distance_operations = distance.full_weights() ? elements * (1 + dimension) : elements};
}

/// Returns the cost of a point that a step computes: its array, if it needs one; of a projected
/// point with an offset also one for the centred point.
Cost point_cost(const check::Model& model, const check::Point& point) {
    if (!point.is_projected()) {
        const bool in_place =
            point.is_delayed() && earlier_element_bytes(model, point.inner) == sizeof(float);
        return {.stack_bytes = in_place ? 0 : point.dimension * kWord, .code_bytes = kCodePerRing};
    }
    const check::Projection& map = model.projections[point.projection];
    const std::uint64_t centred = map.offset.empty() ? 0 : map.dimension;
    return {.stack_bytes = (map.rows + centred) * kWord,
            .code_bytes = kCodePerRing,
            .distance_operations = std::uint64_t{map.rows} * map.dimension};
}

std::uint64_t bytes_of_element(check::InputType type) {
    if (type == check::InputType::i8) return sizeof(std::int8_t);
    return type == check::InputType::f16 ? sizeof(std::uint16_t) : sizeof(float);
}

Cost hold_cost(const check::Input& input) {
    if (input.hold == 0) return {};
    return {.state_bytes = (std::uint64_t{input.dimension} + 1) * kWord,
            .code_bytes = kCodePerRing,
            .operations = 1};
}

/// Returns the cost of `stale after`: the last sample as the input stores it, and a counter.
Cost stale_cost(const check::Input& input) {
    if (input.stale_after == 0) return {};
    const std::uint64_t sample = bytes_of_element(input.type) * input.dimension;
    return {.state_bytes = (sample + kWord - 1) / kWord * kWord + kWord,
            .code_bytes = kCodePerRing,
            .operations = 1,
            .distance_operations = input.is_embedding() ? input.dimension : 0};
}

/// Collects the parts of a plan that one monitor, or all of them, need.
class Needs {
public:
    explicit Needs(const Plan& plan) : plan_(plan) {}

    void stream(Slot slot) {
        if (!streams_.insert(slot).second) return;
        const Stream& s = plan_.streams[slot];
        if (s.op == StreamOp::predicate) predicate(s.index);
        if (s.op == StreamOp::flag) inputs_.insert(s.index);
        for (Slot operand : s.operands) stream(operand);
    }

    void reading(std::uint32_t index) {
        if (!readings_.insert(index).second) return;
        const Reading& r = plan_.readings[index];
        for (std::uint32_t operand : r.operands) reading(operand);
        for_each_slot(r, [&](Slot slot) { stream(slot); });
    }

    void monitor(const Monitor& monitor) {
        monitor.sliding ? stream(monitor.stream) : reading(monitor.reading);
    }

    Cost cost() const {
        const check::Model& model = *plan_.model;
        Cost sum;
        for (Slot slot : streams_) sum = sum + cost_of(plan_.streams[slot], plan_.values);
        for (std::uint32_t index : readings_)
            sum = sum + cost_of(plan_.readings[index], plan_.values);
        for (Index p : predicates_) sum = sum + telemetry(model.predicates[p]);
        for (Index p : pasts_) sum = sum + cost_of(model.pasts[p]);
        const std::vector<Index> distances(distances_.begin(), distances_.end());
        for (Index p : built_points(model, distances))
            sum = sum + point_cost(model, model.points[p]);
        for (const EarlierPoint& earlier : earlier_points(model, distances))
            sum = sum + cost_of(model, earlier);
        for (Index d : distances_) {
            sum = sum + distance_cost(model, model.distances[d]);
            if (searches(plan_, d))
                sum.state_bytes += search_bytes(model.targets[model.distances[d].target]);
        }
        sum.target_bytes = target_bytes(plan_, distances_, Vectors::with);
        sum.scalar_target_bytes = target_bytes(plan_, distances_, Vectors::without);
        for (Index i : inputs_)
            sum = sum + hold_cost(model.inputs[i]) + stale_cost(model.inputs[i]);
        return sum;
    }

private:
    Cost telemetry(const check::Predicate& predicate) const {
        if (predicate.name.empty()) return {.code_bytes = kCodePerRing};
        Cost cost{.state_bytes = predicate.plain_distance() ? 2 * kWord : kWord,
                  .code_bytes = kCodePerRing};
        if (!predicate.plain_distance())
            cost.state_bytes += kWord * check::measured_targets(*plan_.model, predicate).size();
        if (predicate.threshold.adaptation)
            cost = cost + Cost{.state_bytes = kWord, .code_bytes = kCodePerAdaptation};
        return cost;
    }

    void predicate(Index index) {
        if (!predicates_.insert(index).second) return;
        const check::Predicate& p = plan_.model->predicates[index];
        inputs_.insert(p.inputs.begin(), p.inputs.end());
        check::for_each(p.expression, [&](const check::Expr& e) {
            if (e.kind == check::Expr::Kind::distance) distances_.insert(e.index);
            if (e.kind == check::Expr::Kind::past) pasts_.insert(e.index);
        });
    }

    const Plan& plan_;
    std::set<Slot> streams_;
    std::set<std::uint32_t> readings_;
    std::set<Index> pasts_;
    std::set<Index> predicates_;
    std::set<Index> distances_;
    std::set<Index> inputs_;
};

}  // namespace

std::uint64_t measured_elements(const check::Model& model, Index predicate) {
    std::uint64_t sum = 0;
    check::for_each_distance(model.predicates[predicate].expression, [&](Index d) {
        sum += distance_cost(model, model.distances[d]).distance_operations;
    });
    return sum;
}

std::uint64_t elements_of(const check::Model& model, Index predicate) {
    std::uint64_t sum = measured_elements(model, predicate);
    for (const Index p : projected_points(model, model.predicates[predicate].distances()))
        sum += point_cost(model, model.points[p]).distance_operations;
    return sum;
}

Cost operator+(Cost a, const Cost& b) {
    a.state_bytes += b.state_bytes;
    a.stack_bytes += b.stack_bytes;
    a.target_bytes += b.target_bytes;
    a.scalar_target_bytes += b.scalar_target_bytes;
    a.code_bytes += b.code_bytes;
    a.operations += b.operations;
    a.distance_operations += b.distance_operations;
    return a;
}

bool within(const Cost& cost, const Limits& limits) {
    return cost.state_bytes + cost.stack_bytes <= limits.state_bytes &&
           cost.code_bytes <= limits.code_bytes && cost.operations <= limits.operations;
}

std::string in_words(const Cost& cost) {
    const std::string stack = cost.stack_bytes == 0
                                  ? ""
                                  : fmt::format(" and {} on the stack of a step", cost.stack_bytes);
    return fmt::format("{} bytes of state{}, {} bytes of code (estimated), {} operations a step",
                       cost.state_bytes, stack, cost.code_bytes, cost.operations);
}

Cost cost_of(const check::Model& model, const EarlierPoint& earlier) {
    return {
        .state_bytes = etlmon::earlier_bytes(earlier_element_bytes(model, earlier.point),
                                             model.points[earlier.point].dimension, earlier.steps),
        .code_bytes = kCodePerRing,
        .operations = 1};
}

Cost cost_of(const Stream& stream, Values kind) {
    return keeping(work_of(stream, kind), members_of(stream), kind);
}

Cost cost_of(const Reading& reading, Values kind) {
    return keeping(work_of(reading, kind), members_of(reading), kind);
}

Cost cost_of(const check::Past& past) {
    using Kind = check::Past::Kind;
    const std::uint64_t numbers = past.steps * kWord;
    switch (past.kind) {
        case Kind::ago: return {.state_bytes = kWord + numbers, .code_bytes = kCodePerRing};
        case Kind::mean:
            return {.state_bytes = sizeof(etlmon::MeanState) + numbers, .code_bytes = kCodePerMean};
        case Kind::min:
        case Kind::max: break;
        case Kind::count: return {};
    }
    return {.state_bytes = (2 + etlmon::window_elements(past.steps)) * kWord,
            .code_bytes = kCodePerWindow + kCodePerRing,
            .operations = etlmon::window_operations(past.steps)};
}

Cost cost_of_table(std::size_t states, std::size_t transitions, Values kind) {
    const Member table{.kind = Member::Kind::machine, .length = static_cast<std::uint32_t>(states)};
    return keeping(table_cost(states, transitions), {table}, kind);
}

void add_costs(Plan& plan) {
    const ValueType& type = value_type(plan.values);
    Needs all(plan);
    Cost fixed{.state_bytes = kWord};  // missing steps
    if (plan.counts_steps) fixed.state_bytes += kWord;
    if (plan.has_sliding) fixed.state_bytes += kWord;  // calls of finish()
    for (const Monitor& monitor : plan.monitors) {
        Needs own(plan);
        own.monitor(monitor);
        all.monitor(monitor);
        plan.monitor_costs.push_back(own.cost());
        // The last verdict is kept where a final one stays, and where finish() repeats those of
        // prefix monitors.
        const bool kept = type.on_demand || (plan.has_sliding && !monitor.sliding);
        if (kept) fixed.state_bytes += type.verdict;
        if (monitor.counts_steps) fixed.state_bytes += kWord;
        const bool counts_verdicts = monitor.restarts == check::Restarts::when_final;
        if (counts_verdicts) fixed.state_bytes += 2 * kWord;  // alarms and fulfilments
    }
    if (type.sourced) {
        fixed.state_bytes += bytes_of(samples(plan), plan.monitors.size());
        fixed.code_bytes += kCodePerSamples;
    }
    for (const Let& let : plan.lets) {
        all.stream(let.stream);
        fixed.state_bytes += type.verdict;
    }
    plan.cost = all.cost() + fixed;
    plan.cost.state_bytes = (plan.cost.state_bytes + kWord - 1) / kWord * kWord;
}

}  // namespace etlc::plan
