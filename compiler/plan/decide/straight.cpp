#include "plan/decide/straight.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

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
        // Once the right side decides, the left one is irrelevant: evaluated on demand, it is not
        // queried.
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

Term best_of(bool max, const std::vector<Limited>& limited) {
    std::vector<std::pair<Term, std::vector<Term>>> by_limit;
    for (const Limited& one : limited) {
        auto known = std::find_if(by_limit.begin(), by_limit.end(),
                                  [&](const auto& entry) { return entry.first == one.limit; });
        if (known == by_limit.end()) known = by_limit.insert(known, {one.limit, {}});
        known->second.push_back(one.value);
    }
    std::vector<Term> terms;
    for (auto& [limit, values] : by_limit)
        terms.push_back(Term::extreme(!max, {Term::extreme(max, std::move(values)), limit}));
    return Term::extreme(max, std::move(terms));
}

namespace {

// ---- what G responds with, and what its dual does

Op either(bool always) {
    return always ? Op::disjunction : Op::conjunction;
}
Op both(bool always) {
    return either(!always);
}
Op seek(bool always) {
    return always ? Op::eventually : Op::always;
}

/// The parts of an answer in two parts, p && F[c,d] q.
struct InTwo {
    std::vector<NodeId> begins;  ///< operands of p, which is their min (in the dual: max)
    NodeId completes = 0;        ///< q
    ir::Interval within;         ///< [c,d], bounded
};

/// The parts of G[A,B] (f || F[a,b] g).
struct Asked {
    bool of_always = true;  ///< else the dual
    ir::Interval outer;
    ir::Interval inner;  ///< bounded
    NodeId body = 0;
    NodeId answer = 0;  ///< g
    std::vector<NodeId>
        excuses;  ///< operands of f, which is their max (in the dual: min); none: false
    std::optional<InTwo> in_two;  ///< parts of g if it looks ahead
};

/// Returns the operands of a formula of this operation, else the formula alone.
std::vector<NodeId> parts(const ir::Graph& graph, NodeId id, Op op) {
    return graph[id].op == op ? graph[id].operands : std::vector<NodeId>{id};
}

/// Returns the single part that looks ahead, a bounded F (in the dual: G); puts the others into
/// `rest`.
std::optional<NodeId> ahead(const ir::Graph& graph, const std::vector<NodeId>& parts, Op op,
                            std::vector<NodeId>& rest) {
    std::optional<NodeId> found;
    for (NodeId part : parts) {
        if (!graph[part].has_future) {
            rest.push_back(part);
            continue;
        }
        if (found || graph[part].op != op || !graph[part].interval.bounded()) return std::nullopt;
        found = part;
    }
    return found;
}

std::optional<InTwo> in_two(const ir::Graph& graph, NodeId answer, bool of_always) {
    InTwo result;
    const auto last =
        ahead(graph, parts(graph, answer, both(of_always)), seek(of_always), result.begins);
    if (!last || result.begins.empty()) return std::nullopt;
    result.completes = graph[*last].operands[0];
    result.within = graph[*last].interval;
    if (graph[result.completes].has_future) return std::nullopt;
    return result;
}

std::optional<Asked> asked(const ir::Graph& graph, NodeId id) {
    const Node& node = graph[id];
    const bool of_always = node.op == Op::always;
    if (!of_always && node.op != Op::eventually) return std::nullopt;
    Asked result{.of_always = of_always, .outer = node.interval, .body = node.operands[0]};
    const auto inner =
        ahead(graph, parts(graph, result.body, either(of_always)), seek(of_always), result.excuses);
    if (!inner) return std::nullopt;
    result.inner = graph[*inner].interval;
    result.answer = graph[*inner].operands[0];
    if (!graph[result.answer].has_future) return result;
    result.in_two = in_two(graph, result.answer, of_always);
    return result.in_two ? std::optional(result) : std::nullopt;
}

/// The streams of a response.
struct Answering {
    Term passed;  ///< value of the windows that close at this step, from `passes_from` on
    std::uint32_t passes_from = 0;
    Term pending;  ///< value of the open windows; false where none began at the last positions
    Term recent;   ///< value for positions whose windows have not begun
    std::optional<Term> hope;  ///< additional unseen value
};

/// Returns f at the positions of [A,B]; elsewhere nothing is asked.
Slot excuse_of(StreamBuilder& streams, ir::Graph& graph, const Asked& asked, source::Span span) {
    const bool always = asked.of_always;
    const Slot stated = asked.excuses.empty()
                            ? streams.constant(neutral(always))
                            : streams.of(graph.combine(either(always), asked.excuses, span));
    return streams.within(stated, asked.outer, neutral(!always));
}

Answering answering(StreamBuilder& streams, ir::Graph& graph, const Asked& asked,
                    source::Span span) {
    const bool always = asked.of_always;
    const Value idle = neutral(!always);  // where nothing is asked
    const Value urgent = neutral(always);
    const Slot answer = streams.of(asked.answer);
    const auto [low, high] = asked.inner;
    Answering result{.passes_from = high, .recent = Term::constant(idle)};
    if (asked.excuses.empty() && asked.outer == ir::Interval{}) {
        result.passed = streams.term(streams.of(asked.body));
        result.pending = low == 0 ? streams.term(answer) : Term::constant(urgent);
        return result;
    }
    const Slot excuse = excuse_of(streams, graph, asked, span);
    const Slot pending = streams.pending(always, streams.earlier(excuse, low, idle), answer);
    result.pending = streams.term(pending);
    result.passed = streams.term(streams.recent(always, pending, high - low + 1));
    if (low > 0) result.recent = streams.term(streams.recent(!always, excuse, low));
    return result;
}

/// Returns what was answered at the settled positions, `late` steps ago; before the first, nothing
/// is asked.
Slot answered(StreamBuilder& streams, bool always, Slot excuse, Slot answer, std::uint32_t late) {
    const Value idle = neutral(!always);
    const Slot slot = streams.is_constant(excuse)
                          ? streams.within(answer, {late, kUnbounded}, idle)
                          : streams.pending(always, streams.earlier(excuse, late, idle), answer);
    return streams.call(slot, "answered", "what was asked is answered, where that is settled");
}

/// Builds an answer in two parts. A window spans `width` + 1 steps, and an answer is settled `late`
/// steps after it began.
Answering answering_in_two(StreamBuilder& streams, ir::Graph& graph, const Asked& asked,
                           source::Span span) {
    const bool always = asked.of_always;
    const Value idle = neutral(!always);
    const auto [low, high] = asked.inner;
    const std::uint32_t width = high - low;
    const std::uint32_t late = asked.in_two->within.high;
    const Slot stated = excuse_of(streams, graph, asked, span);
    const Slot excuse = streams.earlier(stated, low, idle);
    const auto pending = [&](Slot answer) {
        return streams.is_constant(excuse) ? answer : streams.pending(always, excuse, answer);
    };
    const Slot begun = streams.of(graph.combine(both(always), asked.in_two->begins, span));
    const Slot settled = answered(streams, always, excuse, streams.of(asked.answer), late);

    const auto across_settled = [&](Slot begun_since, Slot settled_before, std::uint32_t length) {
        return streams.term(
            streams.call(streams.handover(!always, begun_since, settled_before, length), "covered",
                         "windows that are over: answered, or begun since"));
    };

    std::vector<Term> passed{streams.term(streams.recent(always, settled, width + 1))};
    if (width >= late) {
        const Slot before = streams.earlier(settled, width - late, idle);
        std::vector<Term> across{across_settled(begun, before, late)};
        if (width > late)
            across.push_back(streams.term(streams.recent(always, settled, width - late)));
        passed.push_back(Term::extreme(always, std::move(across)));
    } else {
        const Slot earlier = streams.earlier(begun, late - width, neutral(always));
        if (width > 0) passed.push_back(across_settled(earlier, settled, width));
        const Slot begun_lately = streams.recent(always, pending(begun), width + 1);
        passed.push_back(streams.term(streams.within(begun_lately, {width, kUnbounded}, idle)));
    }

    const Slot completed = streams.call(
        streams.combine(!always, {streams.of(asked.in_two->completes),
                                  streams.since(always, excuse, begun, asked.in_two->within)}),
        "completed", "what has begun since it was asked is completed now");
    Answering result{.passed = Term::extreme(!always, std::move(passed)),
                     .pending = streams.term(pending(completed)),
                     .recent = Term::constant(idle)};
    if (low > 0) result.recent = streams.term(streams.recent(!always, stated, low));
    const End end = always ? End::high : End::low;
    const Term completes = streams.term(streams.unseen(asked.in_two->completes), end);
    if (completes != streams.term(streams.unseen(asked.answer), end))
        result.hope =
            Term::extreme(!always, {completes, streams.term(pending(begun)), result.recent});
    return result;
}

}  // namespace

std::optional<Straight> response(StreamBuilder& streams, ir::Graph& graph, NodeId id,
                                 Answer answer) {
    const std::optional<Asked> found = asked(graph, id);
    if (!found || found->in_two.has_value() != (answer == Answer::in_two)) return std::nullopt;
    const bool always = found->of_always;
    const auto worst = [&](std::vector<Term> terms) {
        return Term::extreme(!always, std::move(terms));
    };
    if (found->in_two)
        for (NodeId part : found->in_two->begins)
            if (!streams.is_constant(streams.unseen(part))) return std::nullopt;
    streams.of(found->answer);  // makes judge() compute it first
    const Term unseen_answer =
        streams.term(streams.unseen(found->answer), always ? End::high : End::low);
    const Term unseen_body =
        streams.term(streams.unseen(found->body), always ? End::low : End::high);
    const Answering parts = found->in_two ? answering_in_two(streams, graph, *found, graph[id].span)
                                          : answering(streams, graph, *found, graph[id].span);

    Straight code;
    const Term settled = Term::reg(0);
    code.registers = {value(!always, id)};
    code.registers[0].suffix = "_settled";
    code.registers[0].after = ": where the answer's time is over";
    code.assignments = {
        {.positions = {parts.passes_from, kUnbounded}, .value = worst({settled, parts.passed})}};
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
    std::vector<Term> hopes{open, unseen_answer};
    if (parts.hope) hopes.push_back(*parts.hope);
    (always ? code.upper : code.lower) = worst({settled, Term::extreme(always, std::move(hopes))});
    return code;
}

namespace {

class SequenceWriting {
public:
    SequenceWriting(StreamBuilder& streams, ir::Graph& graph, bool max)
        : streams_(streams), graph_(graph), max_(max) {}

    bool is_sequence(NodeId id) const {
        const Node& node = graph_[id];
        if (!node.has_future) return true;
        if (node.op == both(max_) && !ahead(node)) return false;
        if (node.op == both(max_) || node.op == either(max_))
            return std::all_of(node.operands.begin(), node.operands.end(),
                               [&](NodeId operand) { return is_sequence(operand); });
        const bool waits =
            ir::info(node.op).tense == ir::Tense::future && ir::takes_max(node.op) == max_;
        const bool left_is_present =
            node.operands.size() == 1 || !graph_[node.operands[0]].has_future;
        return waits && left_is_present && is_sequence(node.operands.back());
    }

    Straight write(NodeId id) {
        const Node root = graph_[id];  // a copy: the graph grows meanwhile
        begin(root);
        // Operands have smaller numbers, so everything that arrives at a formula is known.
        while (!arrived_.empty()) {
            const auto [formula, ways] = *arrived_.rbegin();
            arrived_.erase(std::prev(arrived_.end()));
            const Slot way = streams_.combine(max_, ways);
            pass(formula, ways.size() > 1 ? streams_.call(way, "in_time", "") : way);
        }
        const Term best = Term::reg(0);
        Straight code;
        code.registers = {value(max_, id)};
        code.assignments = {
            {.value = Term::extreme(max_, {best, streams_.term(streams_.combine(max_, met_))})}};
        code.rho = code.lower = code.upper = best;
        may_go_on_.insert(may_go_on_.begin(), best);
        const Term later = Term::extreme(max_, std::move(may_go_on_));
        // Without a left side, what may begin bounds what has begun, if ranges are all there is.
        const bool bounds = root.operands.size() == 1 && may_begin_.kind == Term::Kind::constant;
        (max_ ? code.upper : code.lower) = Term::before(
            root.interval.high, Term::extreme(max_, {bounds ? best : later, may_begin_}), later);
        return code;
    }

private:
    /// Returns the only operand that looks ahead.
    std::optional<NodeId> ahead(const Node& node) const {
        std::optional<NodeId> found;
        for (NodeId operand : node.operands) {
            if (!graph_[operand].has_future) continue;
            if (found) return std::nullopt;
            found = operand;
        }
        return found;
    }

    Term unseen(NodeId id) {
        return streams_.term(streams_.unseen(id), max_ ? End::high : End::low);
    }

    /// Lets the first thing happen at the positions of the outer interval.
    void begin(const Node& root) {
        const Value none = neutral(max_);
        Slot before = streams_.constant(neutral(!max_));
        Term may_begin = unseen(root.operands.back());
        if (root.operands.size() == 2) {
            const Slot held = streams_.recent(!max_, streams_.of(root.operands[0]), kUnbounded);
            may_begin = Term::extreme(!max_, {streams_.term(held), std::move(may_begin)});
            before = streams_.earlier(held, 1, neutral(!max_));
        }
        may_begin_ = std::move(may_begin);
        arrived_[root.operands.back()] = {streams_.within(before, root.interval, none)};
    }

    void pass(NodeId id, Slot way) {
        const Node node = graph_[id];
        std::vector<NodeId> present;
        for (NodeId operand : node.operands)
            if (!graph_[operand].has_future) present.push_back(operand);
        if (!node.has_future) {
            met_.push_back(streams_.combine(!max_, {way, streams_.of(id)}));
        } else if (node.op == both(max_)) {
            const Slot happens = streams_.of(graph_.combine(node.op, present, node.span));
            arrived_[*ahead(node)].push_back(
                streams_.call(streams_.combine(!max_, {way, happens}), "reached", ""));
        } else if (node.op == either(max_)) {
            for (NodeId operand : node.operands) arrived_[operand].push_back(way);
        } else {
            wait(node, way);
        }
    }

    /// Passes on what has come up to F[a,b] or U[a,b] in the last steps.
    void wait(const Node& node, Slot way) {
        const auto [low, high] = node.interval;
        const bool bounded = node.interval.bounded();
        const NodeId last = node.operands.back();
        std::vector<Slot>& next = arrived_[last];
        if (low == 0) next.push_back(way);
        if (high == 0) return;
        const bool binary = node.operands.size() == 2;
        const Slot left = binary ? streams_.of(node.operands[0]) : kNone;
        // The best way that came up from `from` to `until` steps ago, with the left side since.
        const auto come = [&](std::uint32_t from, std::uint32_t until) {
            if (binary)
                return streams_.since(max_, left, streams_.combine(!max_, {left, way}),
                                      {from, until});
            const std::uint32_t length = bounded ? until - from + 1 : kUnbounded;
            return streams_.earlier(streams_.recent(max_, way, length), from, neutral(max_));
        };
        const std::uint32_t latest = bounded ? high - 1 : kUnbounded;
        const Slot open = streams_.call(come(0, latest), "underway",
                                        "what has come this far, and may still go on");
        may_go_on_.push_back(Term::extreme(!max_, {streams_.term(open), unseen(last)}));
        if (low < 2 || binary)
            next.push_back(
                streams_.earlier(low < 2 ? open : come(low - 1, latest), 1, neutral(max_)));
        else
            next.push_back(come(low, high));
    }

    StreamBuilder& streams_;
    ir::Graph& graph_;
    bool max_;
    std::map<NodeId, std::vector<Slot>> arrived_;
    std::vector<Slot> met_;
    std::vector<Term> may_go_on_;
    Term may_begin_;
};

}  // namespace

std::optional<Straight> sequence(StreamBuilder& streams, ir::Graph& graph, NodeId id) {
    const Node& node = graph[id];
    if (ir::info(node.op).tense != ir::Tense::future) return std::nullopt;
    SequenceWriting writing(streams, graph, ir::takes_max(node.op));
    if (!writing.is_sequence(id)) return std::nullopt;
    return writing.write(id);
}

}  // namespace etlc::plan
