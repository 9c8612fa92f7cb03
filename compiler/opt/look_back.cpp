// F (f && F[a,b] g) is F (g && O[a,b] f), and G (f || G[a,b] g) is G (g || H[a,b] f): whichever of
// two positions is asked first, the pair is the same. The past is a window over one stream, where
// the future is a state per step of it. Only for bounded windows, and f without unbounded past,
// whose range of unseen values would depend on what is known.
#include "opt/opt.hpp"

namespace etlc::opt {

namespace {

using ir::Node;
using ir::NodeId;
using ir::Op;

}  // namespace

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

}  // namespace etlc::opt
