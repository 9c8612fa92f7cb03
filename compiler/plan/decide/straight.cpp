#include "plan/decide/straight.hpp"

namespace etlc::plan {

namespace {

using ir::Node;
using ir::Op;

Member value(bool max, NodeId node) {
    return {.first = neutral(max), .formulas = {node}};
}

}  // namespace

Straight latch(StreamBuilder& streams, NodeId id) {
    const Term kept = Term::reg(0);
    return {.registers = {value(true, id)},
            .locals = {},
            .assignments = {{.positions = {0, 0}, .value = streams.term(streams.of(id))}},
            .rho = kept,
            .lower = kept,
            .upper = kept};
}

Straight fold(StreamBuilder& streams, const Node& node, NodeId id) {
    const bool max = ir::takes_max(node.op);
    const bool binary = node.operands.size() == 2;
    const Slot left = binary ? streams.of(node.operands[0]) : kNone;
    const Slot right = streams.of(node.operands.back());
    const Term best = Term::reg(0);
    const Term guard = binary ? Term::reg(1) : Term::constant(neutral(!max));
    const auto widen = [&](Term a, Term b) {
        return Term::extreme(max, {std::move(a), std::move(b)});
    };
    const auto guarded = [&](Term a) { return Term::extreme(!max, {guard, std::move(a)}); };

    Straight code;
    code.registers = {value(max, id)};
    code.assignments = {
        {.positions = node.interval, .value = widen(best, guarded(streams.term(right)))}};
    if (binary) {
        code.registers.push_back({.first = neutral(!max),
                                  .suffix = "_guard",
                                  .before = "what its left side lets through"});
        // Once the right side has decided, the left one matters no more: where it is found out on
        // demand, nobody asks for it.
        const Term let = streams.term(left);
        code.assignments.push_back(
            {.index = 1, .value = guarded(streams.on_demand(left) ? widen(best, let) : let)});
    }
    const Slot unseen = streams.unseen(node.operands.back());
    const Term hope = guarded(streams.term(unseen, max ? End::high : End::low));
    code.rho = best;
    code.lower = code.upper = best;
    (max ? code.upper : code.lower) = Term::before(node.interval.high, widen(best, hope), best);
    return code;
}

namespace {

/// G[A,B] (f || F[a,b] g), taken apart.
struct Asked {
    bool of_always = true;  ///< else the dual
    ir::Interval outer;
    ir::Interval inner;  ///< bounded
    NodeId body = 0;
    NodeId answer = 0;            ///< g
    std::vector<NodeId> excuses;  ///< f, whose max it is (of the dual: the min); none: false
};

std::optional<Asked> asked(const ir::Graph& graph, NodeId id) {
    const Node& node = graph[id];
    const bool of_always = node.op == Op::always;
    if (!of_always && node.op != Op::eventually) return std::nullopt;
    Asked result{.of_always = of_always, .outer = node.interval, .body = node.operands[0]};
    const Node& body = graph[result.body];
    std::vector<NodeId> future;
    if (body.op == (of_always ? Op::disjunction : Op::conjunction)) {
        for (NodeId operand : body.operands)
            (graph[operand].has_future ? future : result.excuses).push_back(operand);
    } else {
        future.push_back(result.body);
    }
    if (future.size() != 1) return std::nullopt;
    const Node& inner = graph[future[0]];
    if (inner.op != (of_always ? Op::eventually : Op::always)) return std::nullopt;
    if (graph[inner.operands[0]].has_future || !inner.interval.bounded()) return std::nullopt;
    result.inner = inner.interval;
    result.answer = inner.operands[0];
    return result;
}

/// What a response is made of, as streams.
struct Answering {
    Term passed;   ///< what the windows that close at this step came to
    Term pending;  ///< what open windows say; hopeless where none has begun at the last positions
    Term recent;   ///< what speaks for positions whose windows have not begun
};

Answering answering(StreamBuilder& streams, ir::Graph& graph, const Asked& asked,
                    source::Span span) {
    const bool always = asked.of_always;
    const Value idle = neutral(!always);  // where nothing is asked
    const Value urgent = neutral(always);
    const Slot answer = streams.of(asked.answer);
    const auto [low, high] = asked.inner;
    Answering result{.recent = Term::constant(idle)};
    if (asked.excuses.empty() && asked.outer == ir::Interval{}) {
        result.passed = streams.term(streams.of(asked.body));
        result.pending = low == 0 ? streams.term(answer) : Term::constant(urgent);
        return result;
    }
    const Op either = always ? Op::disjunction : Op::conjunction;
    const Slot stated = asked.excuses.empty()
                            ? streams.constant(urgent)
                            : streams.of(graph.combine(either, asked.excuses, span));
    const Slot excuse = streams.within(stated, asked.outer, idle);
    const Slot pending = streams.pending(always, streams.earlier(excuse, low, idle), answer);
    result.pending = streams.term(pending);
    result.passed = streams.term(streams.recent(always, pending, high - low + 1));
    if (low > 0) result.recent = streams.term(streams.recent(!always, excuse, low));
    return result;
}

}  // namespace

std::optional<Straight> response(StreamBuilder& streams, ir::Graph& graph, NodeId id) {
    const std::optional<Asked> found = asked(graph, id);
    if (!found) return std::nullopt;
    const bool always = found->of_always;
    const auto worst = [&](std::vector<Term> terms) {
        return Term::extreme(!always, std::move(terms));
    };
    streams.of(found->answer);  // so that judge() computes it before what is made of it
    const Term unseen_answer =
        streams.term(streams.unseen(found->answer), always ? End::high : End::low);
    const Term unseen_body =
        streams.term(streams.unseen(found->body), always ? End::low : End::high);
    const Answering parts = answering(streams, graph, *found, graph[id].span);

    Straight code;
    const Term settled = Term::reg(0);
    code.registers = {value(!always, id)};
    code.registers[0].suffix = "_settled";
    code.registers[0].after = ": where the answer's time is over";
    code.assignments = {
        {.positions = {found->inner.high, kUnbounded}, .value = worst({settled, parts.passed})}};
    Term open = parts.pending;
    if (parts.recent != Term::constant(neutral(!always))) {
        code.locals = {"_recent"};
        code.assignments.push_back(
            {.target = Term::Kind::local, .value = worst({open, parts.recent})});
        open = Term::local(0);
    }
    code.rho = worst({settled, open});
    (always ? code.lower : code.upper) =
        Term::before(found->outer.high, worst({settled, open, unseen_body}), code.rho);
    (always ? code.upper : code.lower) =
        worst({settled, Term::extreme(always, {open, unseen_answer})});
    return code;
}

}  // namespace etlc::plan
