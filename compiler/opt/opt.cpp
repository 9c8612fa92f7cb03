#include "opt/opt.hpp"

#include <algorithm>
#include <unordered_map>
#include <utility>

namespace etlc::opt {

namespace {

/// Applies a pass bottom-up, each node once.
class Rewriting {
public:
    Rewriting(ir::Graph& graph, const Pass& pass) : graph_(graph), pass_(pass) {}

    ir::NodeId rewrite(ir::NodeId id) {
        if (const auto known = done_.find(id); known != done_.end()) return known->second;
        const bool above_time = ir::info(graph_[id].op).arity == ir::Arity::many;
        const ir::NodeId inside = pass_.at_start_only && !above_time ? id : rebuild(id);
        const ir::NodeId result = pass_.rule(graph_, inside);
        done_.emplace(id, result);
        return result;
    }

private:
    ir::NodeId rebuild(ir::NodeId id) {
        const ir::Node node = graph_[id];  // a copy: the graph grows meanwhile
        std::vector<ir::NodeId> operands;
        for (ir::NodeId operand : node.operands) operands.push_back(rewrite(operand));
        switch (ir::info(node.op).arity) {
            case ir::Arity::atom: return id;
            case ir::Arity::unary:
                if (ir::counts(node.op))
                    return graph_.count(node.op, node.index, node.interval.high, operands[0],
                                        node.counted, node.span);
                return graph_.unary(node.op, node.interval, operands[0], node.span);
            case ir::Arity::binary:
                return graph_.binary(node.op, node.interval, operands[0], operands[1], node.span);
            case ir::Arity::many: return graph_.combine(node.op, std::move(operands), node.span);
        }
        return id;
    }

    ir::Graph& graph_;
    const Pass& pass_;
    std::unordered_map<ir::NodeId, ir::NodeId> done_;
};

}  // namespace

const std::vector<Pass>& passes() {
    static const std::vector<Pass> table = {
        {"distribute", distribute},
        {"split_until", split_until, true},
        {"look_back", look_back, true},
    };
    return table;
}

void optimise(ir::Program& program) {
    for (const Pass& pass : passes()) {
        Rewriting rewriting(program.graph, pass);
        for (std::size_t m = 0; m < program.monitors.size(); ++m) {
            const check::Monitor& monitor = program.graph.model().monitors[m];
            const bool stays_at_start = monitor.restarts == check::Restarts::never;
            if (!monitor.sliding && (stays_at_start || !pass.at_start_only))
                program.monitors[m] = rewriting.rewrite(program.monitors[m]);
        }
    }
    split_windows(program);
    ir::verify(program.graph);
}

// The rules of opt.hpp.

namespace {

using ir::Node;
using ir::NodeId;
using ir::Op;

/// Returns the connective that the operator distributes over, or the operator itself if there is
/// none.
Op distributes_over(Op op) {
    switch (op) {
        case Op::eventually:
        case Op::until: return Op::disjunction;
        case Op::always:
        case Op::release: return Op::conjunction;
        default: return op;
    }
}

NodeId apply(ir::Graph& graph, const Node& node, NodeId right) {
    if (ir::info(node.op).arity == ir::Arity::unary)
        return graph.unary(node.op, node.interval, right, node.span);
    return graph.binary(node.op, node.interval, node.operands[0], right, node.span);
}

}  // namespace

/// Rewrites F (f || g) to F f || F g, G (f && g) to G f && G g, and likewise for the right side of
/// U and R, over any interval: max distributes over max. Monitors of the parts add their states;
/// the whole would multiply them.
NodeId distribute(ir::Graph& graph, NodeId id) {
    const Node node = graph[id];
    const Op connective = distributes_over(node.op);
    if (connective == node.op) return id;
    const Node inner = graph[node.operands.back()];
    if (inner.op != connective || !inner.has_future) return id;

    std::vector<NodeId> present;  // these need no state, so they stay together
    std::vector<NodeId> parts;
    for (NodeId operand : inner.operands) {
        if (graph[operand].has_future)
            parts.push_back(apply(graph, node, operand));
        else
            present.push_back(operand);
    }
    if (!present.empty())
        parts.push_back(
            apply(graph, node, graph.combine(connective, std::move(present), inner.span)));
    return graph.combine(connective, std::move(parts), node.span);
}

/// Rewrites F (f && F[a,b] g) to F (g && O[a,b] f), and G (f || G[a,b] g) to G (g || H[a,b] f): the
/// pair of positions is the same, whichever comes first. The past is a window over one stream,
/// while the future is a state per step. Only for bounded windows, and f without unbounded past,
/// whose range of unseen values would depend on what is known.
NodeId look_back(ir::Graph& graph, NodeId id) {
    const Node outer = graph[id];
    const bool seeks = outer.op == Op::eventually;
    if ((!seeks && outer.op != Op::always) || outer.interval != ir::Interval{}) return id;
    const Op connective = seeks ? Op::conjunction : Op::disjunction;
    const Node inner = graph[outer.operands[0]];
    if (inner.op != connective) return id;

    std::vector<NodeId> future;
    std::vector<NodeId> present;
    for (NodeId operand : inner.operands)
        (graph[operand].has_future ? future : present).push_back(operand);
    if (future.size() != 1 || present.empty()) return id;
    const Node window = graph[future[0]];
    if (window.op != outer.op || !window.interval.bounded()) return id;
    const NodeId earlier = graph.combine(connective, std::move(present), inner.span);
    if (graph[earlier].unbounded_past) return id;

    const NodeId past =
        graph.unary(seeks ? Op::once : Op::historically, window.interval, earlier, window.span);
    const NodeId pair = graph.combine(connective, {window.operands[0], past}, inner.span);
    return look_back(graph, graph.unary(outer.op, {}, pair, outer.span));
}

/// Rewrites G (f || (p U[0,b] q)) to G (f || F[0,b] q) && G (p || T), where T, min over j of
/// max(f(j), q over [j, now]), says that no f is waiting for its q: while one is, p must hold.
/// Without f, G (p U[0,b] q) becomes G F[0,b] q && G (p || q). With a window from a > 0 on, p must
/// hold at every position: G (p U[a,b] q) becomes G p && G F[a,b] q. The dual likewise. The
/// identities hold for truth values on every prefix, and so for min and max: both only compare.
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
