#include "plan/decide/streams.hpp"

#include <algorithm>
#include <cassert>

#include "plan/program/value_type.hpp"

namespace etlc::plan {

namespace {

using etlmon::kBottom;
using etlmon::kFalse;
using etlmon::kTop;
using etlmon::kTrue;
using ir::Node;
using ir::Op;

constexpr Value kAnything{kBottom, kTop};

bool equal(Value a, Value b) {
    return a.low == b.low && a.high == b.high;
}

}  // namespace

Slot StreamBuilder::intern(Stream stream) {
    Identity identity{stream.op,           stream.max,           stream.operands,
                      stream.index,        stream.length,        stream.value.low,
                      stream.value.high,   stream.lag,           stream.operand_lag,
                      stream.interval.low, stream.interval.high, stream.begins_with};
    const auto [entry, added] =
        interned_.emplace(std::move(identity), static_cast<Slot>(streams_.size()));
    if (added) {
        on_demand_.push_back(value_type(values_).on_demand && found_on_demand(stream, on_demand_));
        streams_.push_back(std::move(stream));
    } else if (streams_[entry->second].node == kNone) {
        streams_[entry->second].node = stream.node;
    }
    return entry->second;
}

Term StreamBuilder::term(Slot slot, End end) const {
    const Stream& stream = streams_[slot];
    if (stream.op != StreamOp::constant) return Term::stream(slot);
    const auto [low, high] = stream.value;
    if (end == End::low) return Term::constant({low, low});
    if (end == End::high) return Term::constant({high, high});
    return Term::constant(stream.value);
}

Slot StreamBuilder::constant(Value value) {
    return intern({.op = StreamOp::constant, .value = value});
}

Slot StreamBuilder::of(NodeId id) {
    if (const auto known = slots_.find(id); known != slots_.end()) return known->second;
    const Node& node = graph_[id];
    Slot slot = 0;
    switch (node.op) {
        case Op::constant_true: slot = constant(kTrue); break;
        case Op::constant_false: slot = constant(kFalse); break;
        case Op::predicate:
        case Op::flag: slot = literal(node, id); break;
        case Op::conjunction:
        case Op::disjunction: slot = aligned_combination(node, id); break;
        case Op::once:
        case Op::historically: slot = past_unary(node, id); break;
        case Op::since:
        case Op::trigger: slot = past_binary(node, id); break;
        case Op::at_least:
        case Op::all_but: slot = count(node, id); break;
        case Op::eventually:
        case Op::always: slot = future_unary(node, id); break;
        case Op::until:
        case Op::release: slot = future_binary(node, id); break;
    }
    slots_.emplace(id, slot);
    return slot;
}

Slot StreamBuilder::literal(const Node& node, NodeId id) {
    const StreamOp op = node.op == Op::predicate ? StreamOp::predicate : StreamOp::flag;
    if (!node.negated) return intern({.op = op, .index = node.index, .node = id});
    const Slot positive = intern({.op = op, .index = node.index});
    return intern({.op = StreamOp::negation, .operands = {positive}, .node = id});
}

Slot StreamBuilder::combine(bool max, std::vector<Slot> operands, NodeId node) {
    Value folded = neutral(max);
    std::vector<Slot> kept;
    std::uint32_t lag = 0;
    for (Slot slot : operands) {
        const Stream& stream = streams_[slot];
        lag = std::max(lag, stream.lag);
        if (stream.op == StreamOp::constant)
            folded = max ? max_of(folded, stream.value) : min_of(folded, stream.value);
        else
            kept.push_back(slot);
    }
    if (!equal(folded, neutral(max)) || kept.empty()) kept.push_back(constant(folded));
    std::sort(kept.begin(), kept.end());
    kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
    if (kept.size() == 1) return kept.front();
    return intern({.op = StreamOp::combination,
                   .max = max,
                   .operands = std::move(kept),
                   .lag = lag,
                   .operand_lag = lag,
                   .node = node});
}

Slot StreamBuilder::delayed(Slot slot, std::uint32_t steps) {
    const Stream stream = streams_[slot];
    if (steps == 0 || stream.op == StreamOp::constant) return slot;
    return intern({.op = StreamOp::delay,
                   .operands = {slot},
                   .length = steps,
                   .lag = stream.lag + steps,
                   .operand_lag = stream.lag});
}

std::vector<Slot> StreamBuilder::align(const std::vector<NodeId>& nodes) {
    std::vector<Slot> slots;
    std::uint32_t lag = 0;
    for (NodeId id : nodes) {
        slots.push_back(of(id));
        lag = std::max(lag, streams_[slots.back()].lag);
    }
    for (Slot& slot : slots) slot = delayed(slot, lag - streams_[slot].lag);
    return slots;
}

Slot StreamBuilder::aligned_combination(const Node& node, NodeId id) {
    return combine(node.op == Op::disjunction, align(node.operands), id);
}

Slot StreamBuilder::running(bool max, Slot slot, NodeId node, std::uint32_t begins_with) {
    const std::uint32_t lag = streams_[slot].lag;
    return intern({.op = StreamOp::running,
                   .max = max,
                   .operands = {slot},
                   .lag = lag,
                   .operand_lag = lag,
                   .begins_with = begins_with,
                   .node = node});
}

Slot StreamBuilder::shift(Slot slot, std::uint32_t steps, std::uint32_t lag, Value before,
                          NodeId node, std::uint32_t begins_with) {
    if (steps == 0) return slot;
    // A constant is the same at every position: only the existence of the position matters.
    if (lag == 0 && streams_[slot].op == StreamOp::constant)
        return within(slot, {steps, kUnbounded}, before, begins_with);
    return intern({.op = StreamOp::shift,
                   .operands = {slot},
                   .length = steps,
                   .value = before,
                   .lag = lag,
                   .operand_lag = lag,
                   .begins_with = begins_with,
                   .node = node});
}

Slot StreamBuilder::window(StreamOp op, bool max, std::vector<Slot> operands, std::uint32_t length,
                           std::uint32_t operand_lag, std::uint32_t lag, NodeId node,
                           std::uint32_t begins_with) {
    return intern({.op = op,
                   .max = max,
                   .operands = std::move(operands),
                   .length = length,
                   .lag = lag,
                   .operand_lag = operand_lag,
                   .begins_with = begins_with,
                   .node = node});
}

Slot StreamBuilder::within(Slot slot, ir::Interval interval, Value elsewhere,
                           std::uint32_t begins_with) {
    if (interval == ir::Interval{}) return slot;
    return intern({.op = StreamOp::within,
                   .operands = {slot},
                   .interval = interval,
                   .value = elsewhere,
                   .begins_with = begins_with});
}

/// "Since the last answer", but satisfied where nothing has been asked yet.
Slot StreamBuilder::pending(bool of_always, Slot excuse, Slot answer) {
    return intern({.op = StreamOp::since,
                   .max = of_always,
                   .operands = {excuse, answer},
                   .value = neutral(!of_always),
                   .begins_with = begins_with_});
}

Slot StreamBuilder::recent(bool max, Slot slot, std::uint32_t length) {
    if (length == 1) return slot;
    if (length == kUnbounded) return running(max, slot, kNone, begins_with_);
    return window(StreamOp::window, max, {slot}, length, 0, 0, kNone, begins_with_);
}

Slot StreamBuilder::since(bool max, Slot left, Slot right, ir::Interval interval) {
    if (is_constant(left) && equal(streams_[left].value, neutral(max)))
        return interval.low == 0 ? right : constant(neutral(max));
    return since(max, {left, right}, interval, 0, kNone, begins_with_);
}

Slot StreamBuilder::handover(bool max, Slot before, Slot behind, std::uint32_t length) {
    if (length == 1) return combine(!max, {before, behind});
    return window(StreamOp::window_handover, max, {before, behind}, length, 0, 0, kNone,
                  begins_with_);
}

Slot StreamBuilder::call(Slot slot, std::string_view name, std::string_view holds) {
    Stream& stream = streams_[slot];
    if (stream.node == kNone && stream.called.empty()) {
        stream.called = name;
        stream.holds = holds;
    }
    return slot;
}

/// Builds O[a,b] f at k as O[0,b-a] f at k - a, or false before the trace; H likewise.
Slot StreamBuilder::past_unary(const Node& node, NodeId id) {
    const bool max = ir::takes_max(node.op);
    const auto [low, high] = node.interval;
    const Slot operand = of(node.operands[0]);
    const NodeId inner = low == 0 ? id : kNone;
    const std::uint32_t lag = streams_[operand].lag;
    Slot slot = operand;
    if (high == kUnbounded)
        slot = running(max, operand, inner);
    else if (high > low)
        slot = window(StreamOp::window, max, {operand}, high - low + 1, lag, lag, inner);
    return shift(slot, low, lag, neutral(max), id, kNone);
}

/// Builds f S[a,b] g at k as (f S[0,b-a] g at k - a) && (f at the last a positions); its dual
/// likewise.
Slot StreamBuilder::past_binary(const Node& node, NodeId id) {
    const std::vector<Slot> operands = align(node.operands);
    const std::uint32_t lag = std::max(streams_[operands[0]].lag, streams_[operands[1]].lag);
    return since(ir::takes_max(node.op), operands, node.interval, lag, id, kNone);
}

Slot StreamBuilder::count(const Node& node, NodeId id) {
    const Slot operand = of(node.operands[0]);
    const std::uint32_t lag = streams_[operand].lag;
    return intern({.op = StreamOp::window_count,
                   .max = ir::takes_max(node.op),
                   .operands = {operand},
                   .index = node.index,
                   .length = node.interval.high + 1,
                   .lag = lag,
                   .operand_lag = lag,
                   .node = id});
}

Slot StreamBuilder::since(bool max, const std::vector<Slot>& operands, ir::Interval interval,
                          std::uint32_t lag, NodeId id, std::uint32_t begins_with) {
    const auto [low, high] = interval;
    const NodeId inner = low == 0 ? id : kNone;
    Slot slot = operands[1];
    if (high == kUnbounded)
        slot = intern({.op = StreamOp::since,
                       .max = max,
                       .operands = operands,
                       .value = neutral(max),
                       .lag = lag,
                       .operand_lag = lag,
                       .begins_with = begins_with,
                       .node = inner});
    else if (high > low)
        slot = window(StreamOp::window_since, max, operands, high - low + 1, lag, lag, inner,
                      begins_with);
    if (low == 0) return slot;
    const Slot earlier = shift(slot, low, lag, neutral(max), kNone, begins_with);
    const Slot held =
        low == 1 ? operands[0]
                 : window(StreamOp::window, !max, {operands[0]}, low, lag, lag, kNone, begins_with);
    return combine(!max, {earlier, held}, id);
}

/// Builds F[a,b] f at k, known b steps after f at k: the window over f at k+a .. k+b. A window of
/// one position counts too: the trace may end before it.
Slot StreamBuilder::future_unary(const Node& node, NodeId id) {
    const auto [low, high] = node.interval;
    const Slot operand = of(node.operands[0]);
    const std::uint32_t lag = streams_[operand].lag;
    return window(StreamOp::window, ir::takes_max(node.op), {operand}, high - low + 1, lag,
                  lag + high, id);
}

/// Builds f U[a,b] g at k as (f at k .. k+a-1) && (f U[0,b-a] g at k + a); its dual likewise.
Slot StreamBuilder::future_binary(const Node& node, NodeId id) {
    const bool max = ir::takes_max(node.op);
    const auto [low, high] = node.interval;
    const std::vector<Slot> operands = align(node.operands);
    const std::uint32_t lag = std::max(streams_[operands[0]].lag, streams_[operands[1]].lag);
    const std::uint32_t length = high - low + 1;
    const NodeId inner = low == 0 ? id : kNone;
    const Slot until =
        window(StreamOp::window_until, max, operands, length, lag, lag + high - low, inner);
    if (low == 0) return until;
    const Slot from_there =
        window(StreamOp::window, max, {until}, 1, lag + high - low, lag + high, kNone);
    const Slot held = window(StreamOp::window, !max, {delayed(operands[0], length)}, low,
                             lag + length, lag + high, kNone);
    return combine(!max, {from_there, held}, id);
}

Slot StreamBuilder::unseen(NodeId id) {
    if (const auto known = unseen_.find(id); known != unseen_.end()) return known->second;
    const Node& node = graph_[id];
    Slot slot = 0;
    switch (node.op) {
        case Op::constant_true: slot = constant(kTrue); break;
        case Op::constant_false: slot = constant(kFalse); break;
        case Op::flag: slot = constant(kAnything); break;
        case Op::predicate: {
            const Value range = unseen_range(graph_.model().predicates[node.index], values_);
            slot = constant(node.negated ? negate(range) : range);
            break;
        }
        case Op::conjunction:
        case Op::disjunction: {
            std::vector<Slot> parts;
            for (NodeId operand : node.operands) parts.push_back(unseen(operand));
            slot = combine(node.op == Op::disjunction, std::move(parts));
            break;
        }
        default: slot = unseen_temporal(node, id);
    }
    unseen_.emplace(id, slot);
    return slot;
}

/// F, U, O, S: the lowest unseen value is that of the last operand if a = 0, else -inf; the highest
/// is the operand's. G, R, H and the dual of S: the other way round. Past operators keep seeing
/// what is known of the operand.
Slot StreamBuilder::unseen_temporal(const Node& node, NodeId id) {
    const bool max = ir::takes_max(node.op);
    const Slot operand = unseen(node.operands.back());
    Slot slot = operand;
    // Where it is asked, fewer positions than those counted may exist or hold.
    if (node.interval.low > 0 || ir::counts(node.op))
        slot = combine(!max, {operand, constant(kAnything)});  // one end becomes infinite
    if (ir::info(node.op).tense != ir::Tense::past) return slot;
    const bool unary = ir::info(node.op).arity == ir::Arity::unary;
    if (unary && node.interval == ir::Interval{}) return combine(max, {slot, of(id)});
    if (streams_[operand].op == StreamOp::constant)
        return slot;  // known values lie within a constant range
    const Slot known = running(max, of(node.operands.back()), kNone);
    return combine(max, {slot, combine(!max, {known, constant(kAnything)})});
}

}  // namespace etlc::plan
