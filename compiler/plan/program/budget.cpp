#include "plan/program/budget.hpp"

#include <algorithm>
#include <set>

#include "etlmon/hosted/footprint.hpp"
#include "etlmon/temporal/boolean_verdict.hpp"
#include "etlmon/temporal/reading.hpp"
#include "etlmon/temporal/verdict.hpp"
#include "plan/program/members.hpp"
#include "plan/program/target_bytes.hpp"
#include "plan/stored.hpp"

namespace etlc::plan {

namespace {

using check::Values;

constexpr std::uint64_t kWord = sizeof(std::uint32_t);
constexpr std::uint64_t kKeysPerValue = 2;
/// Of a window whose highs part from its lows: which blocks have highs of their own, and from where
/// (etlmon::Parting).
constexpr std::uint64_t kPartingComparisons = 6;

// Estimated code, measured on x86-64 and Cortex-M4 at -O2 and -Os and rounded up.
constexpr std::uint64_t kCodePerValueOperation = 24;
constexpr std::uint64_t kCodePerWindow = 240;
constexpr std::uint64_t kCodePerRing = 64;
constexpr std::uint64_t kCodePerAdaptation = 144;  // observe_P(), as a Cortex-M4 has it at -Os
constexpr std::uint64_t kCodePerTable = 200;
constexpr std::uint64_t kCodePerFold = 96;
constexpr std::uint64_t kTransitionBytes = sizeof(etlmon::Transition);
constexpr std::uint64_t kStateBytes = sizeof(std::uint32_t) + sizeof(etlmon::Owed);

/// `combined` minima or maxima of two, beside `kept` values.
Cost values(std::uint64_t kept, std::uint64_t combined) {
    return {.code_bytes = (kept + combined) * kCodePerValueOperation,
            .operations = combined * kKeysPerValue};
}

Cost window_cost(std::uint32_t length, std::uint64_t sides) {
    if (length == 1) return {};
    const std::uint64_t combined = etlmon::window_operations(length) * (2 * sides - 1);
    return {.code_bytes = kCodePerWindow * sides,
            .operations = combined * kKeysPerValue + kPartingComparisons};
}

Cost fold_cost(const Fold& fold) {
    const bool binary = fold.left != kNone;
    Cost cost = values(binary ? 2 : 1, binary ? 3 : 1);
    cost.operations += 2 + 3;  // is the window open, does it reach past this step; the bounds
    cost.code_bytes += kCodePerFold;
    return cost;
}

Cost response_cost(const Response& response) {
    Cost cost = values(1, 2 + (response.recent != kNone ? 1 : 0));
    cost.operations +=
        2 +
        3;  // whether windows have closed, whether the outer one reaches past this step; the bounds
    cost.code_bytes += 2 * kCodePerFold;
    return cost;
}

/// Operations on values or readings at one position, in units of the temporal loops of
/// etlmon/temporal/pending.hpp.
std::uint64_t pending_steps(const Pending& pending) {
    std::uint64_t steps = 0;
    for (const Pending::Part& part : pending.parts) {
        const bool temporal = part.unseen != kNone;
        const std::uint64_t window =
            std::min(part.interval.high, pending.horizon) + std::uint64_t{1};
        if (part.leaf == kNone)
            steps += temporal ? (part.operands.size() == 2 ? 3 : 2) * window + 2
                              : part.operands.size() - 1;
    }
    if (pending.is_fold) return steps + 4;
    steps += 2 * pending.machine.states.size() + 2 * pending.machine.automaton.transitions.size();
    for (const auto& guard : pending.guards) steps += guard.size();
    return steps;
}

/// What a reading and a value take on the stack.
struct OnStack {
    std::uint64_t reading;
    std::uint64_t value;
};
OnStack on_stack(Values values) {
    if (values == Values::boolean)
        return {sizeof(etlmon::BasicReading<etlmon::Truth>), sizeof(etlmon::Truth)};
    return {sizeof(etlmon::BasicReading<Value>), sizeof(Value)};
}

Cost pending_cost(const Pending& pending, OnStack of) {
    constexpr std::uint64_t kKeysPerReading = 4;
    const std::uint64_t positions = pending.horizon + std::uint64_t{1};
    Cost cost;
    cost.stack_bytes = pending.parts.size() * positions * of.reading;
    cost.operations = positions * pending_steps(pending) * kKeysPerReading;
    cost.code_bytes = pending.parts.size() * kCodePerWindow + kCodePerTable;
    if (pending.is_fold) return cost;
    const std::size_t states = pending.machine.states.size();
    const std::size_t guards = pending.guards.size();
    // The guards at each position, and what PendingMachine::read works with.
    cost.stack_bytes +=
        (guards * positions + 2 * states) * of.reading + (guards + states) * of.value;
    cost.code_bytes += pending.machine.automaton.transitions.size() * kTransitionBytes +
                       states * kStateBytes + guards * kCodePerValueOperation;
    return cost;
}

Cost table_cost(const AutomatonSize& size) {
    return {.code_bytes =
                kCodePerTable + size.transitions * kTransitionBytes + size.states * kStateBytes,
            .operations = (3 * size.states + 2 * size.transitions) * kKeysPerValue};
}

/// Updates and, for the reading, a state's part in rho, lower and upper: three minima or maxima of
/// values.
Cost machine_cost(const Machine& machine) {
    const std::size_t read = 3 * machine.states.size();
    if (machine.unrolled)
        return values(machine.program.updates.size(), operations(machine.program) + read);
    Cost cost = table_cost({machine.states.size(), machine.automaton.transitions.size()});
    cost.code_bytes += machine.guards.size() * kCodePerValueOperation;
    for (const auto& guard : machine.guards)
        cost.operations += guard.empty() ? 0 : (guard.size() - 1) * kKeysPerValue;
    return cost;
}

/// Code and work of a stream.
Cost work_of(const Stream& stream) {
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
        case StreamOp::widening: return Cost{.code_bytes = kCodePerRing} + values(0, 1);
    }
    return {};
}

/// Code, work and stack of a reading.
Cost work_of(const Reading& reading, Values kind) {
    switch (reading.kind) {
        case Reading::Kind::latch: return values(1, 0);
        case Reading::Kind::fold: return fold_cost(reading.fold);
        case Reading::Kind::response: return response_cost(reading.response);
        case Reading::Kind::machine: return machine_cost(reading.machine);
        case Reading::Kind::pending: return pending_cost(reading.pending, on_stack(kind));
        case Reading::Kind::combination: return values(0, 2 * (reading.operands.size() - 1));
    }
    return {};
}

/// With the bytes of these members.
Cost keeping(Cost cost, const std::vector<Member>& members, Values kind) {
    for (const Member& member : members) cost.state_bytes += bytes_of(member, kind);
    return cost;
}

Cost distance_cost(const check::Model& model, const check::Distance& distance) {
    const check::Target& target = model.targets[distance.target];
    const std::uint64_t elements = std::uint64_t{target.rows} * target.dimension;
    const bool full = distance.metric == check::Metric::mahalanobis && !distance.weights_diagonal;
    return {.distance_operations = full ? elements * (1 + target.dimension) : elements};
}

Cost hold_cost(const check::Input& input) {
    if (input.hold == 0) return {};
    return {.state_bytes = (std::uint64_t{input.dimension} + 1) * kWord,
            .code_bytes = kCodePerRing,
            .operations = 1};
}

/// The parts of a plan that one monitor, or all of them, need.
class Needs {
public:
    explicit Needs(const Plan& plan) : plan_(plan) {}

    void stream(Slot slot) {
        if (slot == kNone || !streams_.insert(slot).second) return;
        const Stream& s = plan_.streams[slot];
        if (s.op == StreamOp::predicate) predicate(s.index);
        if (s.op == StreamOp::flag) inputs_.insert(s.index);
        for (Slot operand : s.operands) stream(operand);
    }

    void reading(std::uint32_t index) {
        if (!readings_.insert(index).second) return;
        const Reading& r = plan_.readings[index];
        for (std::uint32_t operand : r.operands) reading(operand);
        Reading copy = r;
        for (const Slot* slot : slots_of(copy)) stream(*slot);
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
        for (Index d : distances_) {
            sum = sum + distance_cost(model, model.distances[d]);
            if (searches(plan_, d))
                sum.state_bytes += search_bytes(model.targets[model.distances[d].target]);
        }
        sum.target_bytes = target_bytes(plan_, distances_, Vectors::with);
        sum.scalar_target_bytes = target_bytes(plan_, distances_, Vectors::without);
        for (Index i : inputs_) sum = sum + hold_cost(model.inputs[i]);
        return sum;
    }

private:
    static Cost telemetry(const check::Predicate& predicate) {
        if (predicate.name.empty()) return {.code_bytes = kCodePerRing};
        Cost cost{.state_bytes = predicate.plain_distance() ? 2 * kWord : kWord,
                  .code_bytes = kCodePerRing};
        if (predicate.threshold.adaptation)
            cost = cost + Cost{.state_bytes = kWord, .code_bytes = kCodePerAdaptation};
        return cost;
    }

    void predicate(Index index) {
        if (!predicates_.insert(index).second) return;
        const check::Predicate& p = plan_.model->predicates[index];
        inputs_.insert(p.inputs.begin(), p.inputs.end());
        expression(p.expression);
    }

    void expression(const check::Expr& e) {
        if (e.kind == check::Expr::Kind::distance) distances_.insert(e.index);
        for (const check::Expr& argument : e.arguments) expression(argument);
    }

    const Plan& plan_;
    std::set<Slot> streams_;
    std::set<std::uint32_t> readings_;
    std::set<Index> predicates_;
    std::set<Index> distances_;
    std::set<Index> inputs_;
};

}  // namespace

std::uint64_t measured_elements(const check::Model& model, Index predicate) {
    std::uint64_t sum = 0;
    const auto visit = [&](const auto& self, const check::Expr& e) -> void {
        if (e.kind == check::Expr::Kind::distance)
            sum += distance_cost(model, model.distances[e.index]).distance_operations;
        for (const check::Expr& argument : e.arguments) self(self, argument);
    };
    visit(visit, model.predicates[predicate].expression);
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

Cost cost_of(const Stream& stream, Values kind) {
    return keeping(work_of(stream), members_of(stream), kind);
}

Cost cost_of(const Reading& reading, Values kind) {
    return keeping(work_of(reading, kind), members_of(reading), kind);
}

Cost cost_of(const AutomatonSize& size, Values kind) {
    const Member table{.kind = Member::Kind::machine,
                       .length = static_cast<std::uint32_t>(size.states)};
    return keeping(table_cost(size), {table}, kind);
}

void add_costs(Plan& plan) {
    Needs all(plan);
    Cost fixed{.state_bytes = kWord};  // missing steps
    if (plan.counts_steps) fixed.state_bytes += kWord;
    if (plan.has_sliding) fixed.state_bytes += kWord;  // calls of finish()
    for (const Monitor& monitor : plan.monitors) {
        Needs own(plan);
        own.monitor(monitor);
        all.monitor(monitor);
        plan.monitor_costs.push_back(own.cost());
        if (plan.values == Values::boolean)
            fixed.state_bytes +=
                sizeof(etlmon::BooleanVerdict);  // the last one: a final verdict stops computing
        else if (plan.has_sliding && !monitor.sliding)
            fixed.state_bytes += sizeof(etlmon::Verdict);
    }
    plan.cost = all.cost() + fixed;
    plan.cost.state_bytes = (plan.cost.state_bytes + kWord - 1) / kWord * kWord;
}

}  // namespace etlc::plan
