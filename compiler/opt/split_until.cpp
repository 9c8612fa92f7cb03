// G (f || (p U[0,b] q)) is G (f || F[0,b] q) && G (p || T), where T, min over j of max(f(j), q over
// [j, now]), says that no f is waiting for its q: while one is, p must hold. Without f: G (p U[0,b]
// q) is G F[0,b] q && G (p || q). With a window from a > 0 on, p must hold at every position: G (p
// U[a,b] q) is G p && G F[a,b] q. The dual likewise. The identities hold for truth values on every
// prefix, and so for min and max: both only compare.
#include <algorithm>

#include "opt/opt.hpp"

namespace etlc::opt {

namespace {

using ir::Node;
using ir::NodeId;
using ir::Op;

}  // namespace

NodeId split_until(ir::Graph& graph, NodeId id) {
    const Node outer = graph[id];
    const bool responds = outer.op == Op::always;
    if ((!responds && outer.op != Op::eventually) || outer.interval != ir::Interval{}) return id;
    const Op alternative = responds ? Op::disjunction : Op::conjunction;
    const Op both = responds ? Op::conjunction : Op::disjunction;
    const Op wait = responds ? Op::until : Op::release;
    const Op seek = responds ? Op::eventually : Op::always;

    const NodeId body = outer.operands[0];
    std::vector<NodeId> others;
    NodeId found = body;
    if (graph[body].op == alternative) {
        std::vector<NodeId> waits;
        for (NodeId operand : graph[body].operands)
            (graph[operand].op == wait ? waits : others).push_back(operand);
        if (waits.size() != 1) return id;
        found = waits[0];
    }
    const Node until = graph[found];
    if (until.op != wait || !until.interval.bounded() || graph[until.operands[0]].has_future)
        return id;
    if (graph[until.operands[1]].has_future) return id;
    if (std::any_of(others.begin(), others.end(),
                    [&](NodeId other) { return graph[other].has_future; }))
        return id;
    if (until.interval.low > 0 && !others.empty()) return id;

    const auto [p, q] = std::pair(until.operands[0], until.operands[1]);
    const NodeId seen = graph.unary(seek, until.interval, q, until.span);
    NodeId held = p;
    if (until.interval.low == 0) {
        std::vector<NodeId> settled = others;
        settled.push_back(q);
        const NodeId now = graph.combine(alternative, settled, until.span);
        const NodeId waits_for_none =
            others.empty()
                ? q
                : graph.binary(responds ? Op::trigger : Op::since, {}, q, now, until.span);
        held = graph.combine(alternative, {p, waits_for_none}, until.span);
    }
    std::vector<NodeId> response = others;
    response.push_back(seen);
    return graph.combine(
        both,
        {graph.unary(outer.op, {}, graph.combine(alternative, response, outer.span), outer.span),
         graph.unary(outer.op, {}, held, outer.span)},
        outer.span);
}

}  // namespace etlc::opt
