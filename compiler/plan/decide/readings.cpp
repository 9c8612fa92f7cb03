#include "plan/decide/readings.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "plan/budget/budget.hpp"
#include "plan/decide/chain.hpp"
#include "plan/decide/straight.hpp"

namespace etlc::plan {

using ir::Node;
using ir::Op;

namespace {

/// The work of building all state machines of a plan, per transition that one of them may have:
/// 2^27 steps at the default limits, some tenths of a second. It counts steps, not time, so that a
/// spec gives one answer on every machine.
constexpr std::uint64_t kWorkPerTransition = 8192;
/// The share of one machine, so that some work is left for others.
constexpr std::uint64_t kShares = 2;
constexpr std::uint64_t kSmallShares = 16;
constexpr std::uint64_t kChainShares = 128;

/// Machines up to this size are preferred.
constexpr std::size_t kSmallMachineStates = 256;
constexpr std::size_t kSmallMachineTransitions = 2048;
/// Readings with so few operations are not improved further.
constexpr std::uint64_t kFewOperations = 160;
/// Readings with more operations are worth an alternative.
constexpr std::uint64_t kMuchWork = 20'000;

constexpr std::uint64_t kNumbered = 65535;  // tables number states in 16 bits

std::uint64_t most_transitions(const Limits& limits) {
    return std::min({limits.code_bytes / 4, limits.operations, kNumbered}) + 1;
}

std::uint64_t total_work(const Limits& limits) {
    return most_transitions(limits) * kWorkPerTransition;
}

/// Returns the limits of a single automaton; the whole plan is weighed afterwards.
AutomatonLimits machine_limits(const Limits& limits) {
    AutomatonLimits result;
    result.states =
        static_cast<std::size_t>(std::min(kNumbered, limits.state_bytes / (2 * sizeof(Value)) + 1));
    result.transitions = static_cast<std::size_t>(most_transitions(limits));
    result.work = total_work(limits) / kShares;
    return result;
}

AutomatonLimits small_machine_limits(const Limits& limits) {
    const AutomatonLimits any = machine_limits(limits);
    return {std::min(any.states, kSmallMachineStates),
            std::min(any.transitions, kSmallMachineTransitions), total_work(limits) / kSmallShares};
}

/// Limits of an automaton that is compared with a chain. A long chain exceeds them soon.
AutomatonLimits unrolled_machine_limits(const Limits& limits) {
    const AutomatonLimits any = machine_limits(limits);
    return {std::min(any.states, kMaxUnrolledStates),
            std::min(any.transitions, kMaxUnrolledTransitions), total_work(limits) / kChainShares};
}

/// Returns the largest share of a limit; above 1 it does not fit.
double share(const Cost& cost, const Limits& limits) {
    const auto part = [](std::uint64_t need, std::uint64_t limit) {
        return static_cast<double>(need) / static_cast<double>(limit);
    };
    return std::max({part(cost.state_bytes + cost.stack_bytes, limits.state_bytes),
                     part(cost.code_bytes, limits.code_bytes),
                     part(cost.operations, limits.operations)});
}

/// Returns whether an unguarded loop keeps the register of a state at +inf.
bool loops_freely(const Automaton& automaton, std::uint32_t state) {
    return std::any_of(automaton.transitions.begin(), automaton.transitions.end(),
                       [&](const Transition& t) {
                           return t.source == state && t.target == state && t.guard == 0;
                       });
}

}  // namespace

ReadingBuilder::ReadingBuilder(const ir::Program& program, ir::Graph& graph, StreamBuilder& streams,
                               std::vector<Reading>& readings, const Limits& limits,
                               check::Values values)
    : program_(program),
      graph_(graph),
      streams_(streams),
      readings_(readings),
      limits_(limits),
      values_(values),
      work_left_(total_work(limits)) {}

std::optional<std::uint32_t> ReadingBuilder::of(NodeId id) {
    const std::pair key(id, streams_.begins_with());
    if (const auto known = known_.find(key); known != known_.end()) return known->second;
    const Node node = graph_[id];  // a copy: automata make the graph grow
    std::optional<std::uint32_t> reading;
    if (!node.has_future)
        reading = add(id, "latch", latch(streams_, id));
    else if (ir::info(node.op).arity == ir::Arity::many)
        reading = combination(node, id);
    else if (std::none_of(node.operands.begin(), node.operands.end(),
                          [&](NodeId o) { return graph_[o].has_future; }))
        reading = add(id, "fold", fold(streams_, node, id));
    else if (auto code = response(streams_, graph_, id, Answer::at_once))
        reading = add(id, "response", std::move(*code));
    else if (auto links = as_chain(id))
        reading = add(std::move(*links));
    else
        reading = nested(node, id);
    if (reading) known_.emplace(key, *reading);
    return reading;
}

std::uint32_t ReadingBuilder::add(Reading reading) {
    reading.begins_with = streams_.begins_with();
    readings_.push_back(std::move(reading));
    return static_cast<std::uint32_t>(readings_.size() - 1);
}

std::uint32_t ReadingBuilder::add(NodeId id, std::string as, Straight code) {
    return add({.kind = Reading::Kind::straight,
                .node = id,
                .as = std::move(as),
                .straight = std::move(code)});
}

/// Combines the readings of the parts; those without future share one latch.
std::optional<std::uint32_t> ReadingBuilder::combination(const Node& node, NodeId id) {
    std::vector<NodeId> present;
    std::vector<std::uint32_t> parts;
    bool complete = true;
    for (NodeId operand : node.operands) {
        if (!graph_[operand].has_future) {
            present.push_back(operand);
            continue;
        }
        const auto part = of(operand);
        complete = complete && part;
        if (!complete && is_apart_) return std::nullopt;
        if (part) parts.push_back(*part);
    }
    if (!present.empty())
        parts.push_back(*of(graph_.combine(node.op, std::move(present), node.span)));
    if (!complete) return std::nullopt;
    return add({.kind = Reading::Kind::combination,
                .node = id,
                .as = node.op == Op::disjunction ? "max of parts" : "min of parts",
                .max = node.op == Op::disjunction,
                .operands = std::move(parts)});
}

Machine::State ReadingBuilder::state(const std::vector<NodeId>& obligations) {
    const auto strong = [&](NodeId obligation) { return is_strong(graph_[obligation].op); };
    Machine::State state{.strong = std::any_of(obligations.begin(), obligations.end(), strong)};
    // With a strong obligation the lower bound is -inf, whatever the weak ones are.
    std::vector<Slot> unseen;
    for (NodeId obligation : obligations)
        if (strong(obligation) == state.strong) unseen.push_back(streams_.unseen(obligation));
    if (unseen.empty()) return state;
    (state.strong ? state.strong_unseen : state.weak_unseen) =
        streams_.combine(false, std::move(unseen));
    return state;
}

/// Makes the machine of an automaton, without its guards.
Machine ReadingBuilder::machine_of(Automaton automaton) {
    Machine machine;
    for (const auto& obligations : automaton.states) machine.states.push_back(state(obligations));
    machine.states[0].always_true = loops_freely(automaton, 0);
    machine.automaton = std::move(automaton);
    return machine;
}

std::optional<Automaton> ReadingBuilder::automaton(NodeId id, Literals literals,
                                                   AutomatonLimits limits, AutomatonSize& reached) {
    limits.work = std::min(limits.work, work_left_);
    auto result = build_automaton(graph_, id, literals, limits, reached);
    work_left_ -= std::min(work_left_, reached.work);
    return result;
}

std::optional<Machine> ReadingBuilder::machine(NodeId id, const AutomatonLimits& limits) {
    AutomatonSize reached;
    auto built = automaton(id, Literals::without_future, limits, reached);
    if (!built) {
        oversize_.push_back({id, reached});
        return std::nullopt;
    }
    Machine result = machine_of(std::move(*built));
    for (const auto& literals : result.automaton.guards) {
        std::vector<Slot> slots;
        for (NodeId literal : literals) slots.push_back(streams_.of(literal));
        result.guards.push_back(std::move(slots));
    }
    return result;
}

/// Returns the part of `pending` for this formula, and adds its operands before it.
std::uint32_t ReadingBuilder::pending_part(Pending& pending, std::map<NodeId, std::uint32_t>& known,
                                           NodeId id) {
    if (const auto found = known.find(id); found != known.end()) return found->second;
    const Node node = graph_[id];
    Pending::Part part{.node = id};
    if (!node.has_future) {
        part.leaf = streams_.of(id);
    } else {
        part.max = node.op == Op::disjunction || ir::takes_max(node.op);
        part.interval = node.interval;
        for (NodeId operand : node.operands)
            part.operands.push_back(pending_part(pending, known, operand));
        if (ir::info(node.op).tense == ir::Tense::future)
            part.unseen = streams_.unseen(node.operands.back());
    }
    pending.horizon = std::max(pending.horizon, node.horizon);
    pending.parts.push_back(std::move(part));
    return known[id] = static_cast<std::uint32_t>(pending.parts.size() - 1);
}

/// Returns a reading whose cost does not depend on the lengths of its windows.
std::optional<Reading> ReadingBuilder::over_windows(NodeId id) {
    const auto straight = [&](const char* as, Straight code) {
        return Reading{
            .kind = Reading::Kind::straight, .node = id, .as = as, .straight = std::move(code)};
    };
    if (auto code = response(streams_, graph_, id, Answer::in_two))
        return straight("response, answered in two parts", std::move(*code));
    if (auto code = sequence(streams_, graph_, id)) return straight("sequence", std::move(*code));
    return std::nullopt;
}

/// Evaluates the operator, or the automaton of what is unbounded, over parts with a bounded future.
std::optional<Reading> ReadingBuilder::pending(const Node& node, NodeId id) {
    Reading reading{.kind = Reading::Kind::pending, .node = id};
    Pending& pending = reading.pending;
    std::map<NodeId, std::uint32_t> known;
    pending.is_fold = std::all_of(node.operands.begin(), node.operands.end(), [&](NodeId operand) {
        return graph_[operand].horizon != kUnbounded;
    });
    if (pending.is_fold) {
        Pending::Part& fold = pending.fold;
        fold.max = ir::takes_max(node.op);
        fold.interval = node.interval;
        for (NodeId operand : node.operands)
            fold.operands.push_back(pending_part(pending, known, operand));
        fold.unseen = streams_.unseen(node.operands.back());
    } else {
        AutomatonSize reached;
        auto built = automaton(id, Literals::with_bounded_future, machine_limits(limits_), reached);
        if (!built) return std::nullopt;
        Machine machine = machine_of(std::move(*built));
        for (const auto& literals : machine.automaton.guards) {
            std::vector<std::uint32_t> parts;
            for (NodeId literal : literals) parts.push_back(pending_part(pending, known, literal));
            machine.guards.push_back(std::move(parts));
        }
        pending.table = make_table(machine);
    }
    reading.as = fmt::format("{}, again at {} positions",
                             pending.is_fold ? "fold" : "state machine", pending.horizon + 1);
    return reading;
}

/// Reads the formula with its windows split if that takes a smaller share of the limits; else adds
/// nothing.
std::optional<std::uint32_t> ReadingBuilder::apart(NodeId id, double below) {
    const auto found = program_.split_windows.find(id);
    if (found == program_.split_windows.end()) return std::nullopt;
    const std::size_t before = readings_.size();
    const std::size_t failures = oversize_.size();
    is_apart_ = true;  // a part that is too large is not split again
    const auto reading = of(found->second);
    is_apart_ = false;
    oversize_.resize(failures);
    Cost cost;
    for (std::size_t r = before; r < readings_.size(); ++r)
        cost = cost + cost_of(readings_[r], values_);
    if (reading && share(cost, limits_) < below) return reading;
    readings_.resize(before);
    std::erase_if(known_, [&](const auto& entry) { return entry.second >= before; });
    return std::nullopt;
}

/// Makes straight-line code of a small machine, else a table.
Reading ReadingBuilder::as_reading(NodeId id, const Machine& machine) const {
    const bool small = is_small(machine);
    Reading reading{.kind = small ? Reading::Kind::straight : Reading::Kind::table, .node = id};
    reading.as = fmt::format("state machine, {} states, {} transitions{}", machine.states.size(),
                             machine.automaton.transitions.size(), small ? "" : ", as a table");
    if (small)
        reading.straight = straight_line(machine, streams_);
    else
        reading.table = make_table(machine);
    return reading;
}

/// Reads a chain by its own registers. Where phases imply each other, as in F (p && F p), the
/// automaton has fewer. It is taken if it needs fewer operations, or saves more bytes than it adds
/// operations.
std::optional<Reading> ReadingBuilder::as_chain(NodeId id) {
    auto code = chain(streams_, graph_, id);
    if (!code) return std::nullopt;
    Reading reading{
        .kind = Reading::Kind::straight, .node = id, .as = "chain", .straight = std::move(*code)};
    const std::size_t failures = oversize_.size();
    const auto small = machine(id, unrolled_machine_limits(limits_));
    oversize_.resize(failures);
    if (!small) return reading;
    Reading other = as_reading(id, *small);
    const Cost own = cost_of(reading, values_);
    const Cost others = cost_of(other, values_);
    const bool takes_less =
        others.operations < own.operations ||
        others.operations + others.state_bytes < own.operations + own.state_bytes;
    return takes_less ? std::move(other) : std::move(reading);
}

/// Chooses a small machine if there is one, else what takes the fewest operations: pending
/// positions, the formula with its windows split, or a machine up to the limits.
std::optional<std::uint32_t> ReadingBuilder::nested(const Node& node, NodeId id) {
    const std::size_t failures = oversize_.size();
    if (auto small = machine(id, small_machine_limits(limits_))) {
        Reading reading = as_reading(id, *small);
        if (cost_of(reading, values_).operations > kFewOperations)
            if (auto code = over_windows(id)) reading = std::move(*code);
        return add(std::move(reading));
    }
    if (auto code = over_windows(id)) {
        oversize_.resize(failures);
        return add(std::move(*code));
    }
    std::optional<Reading> best = pending(node, id);
    if (best && (best->pending.horizon == 0 || !within(cost_of(*best, values_), limits_)))
        best.reset();
    oversize_.resize(failures);
    if (is_apart_) return best ? std::optional(add(std::move(*best))) : std::nullopt;
    if (!best || cost_of(*best, values_).operations > kMuchWork)
        if (auto large = machine(id, machine_limits(limits_))) {
            Reading reading = as_reading(id, *large);
            if (!best || cost_of(reading, values_).operations < cost_of(*best, values_).operations)
                best = std::move(reading);
        }
    const double whole = best ? share(cost_of(*best, values_), limits_) : 1;
    if (!best || cost_of(*best, values_).operations > kMuchWork)
        if (const auto reading = apart(id, std::min(whole, 1.0))) {
            oversize_.resize(failures);
            return reading;
        }
    if (!best) return std::nullopt;
    oversize_.resize(failures);
    return add(std::move(*best));
}

}  // namespace etlc::plan
