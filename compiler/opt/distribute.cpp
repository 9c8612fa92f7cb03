// F (f || g) is F f || F g, G (f && g) is G f && G g, and so for the right side of U and R, over
// any interval: max distributes over max. Monitors of the parts add their states where the whole
// would multiply them.
#include "opt/opt.hpp"

namespace etlc::opt {

namespace {

/// The connective that the operator distributes over, or the operator itself where there is none.
ir::Op distributes_over(ir::Op op) {
    switch (op) {
        case ir::Op::eventually:
        case ir::Op::until: return ir::Op::disjunction;
        case ir::Op::always:
        case ir::Op::release: return ir::Op::conjunction;
        default: return op;
    }
}

ir::NodeId apply(ir::Graph& graph, const ir::Node& node, ir::NodeId right) {
    if (ir::info(node.op).arity == ir::Arity::unary)
        return graph.unary(node.op, node.interval, right, node.span);
    return graph.binary(node.op, node.interval, node.operands[0], right, node.span);
}

}  // namespace

ir::NodeId distribute(ir::Graph& graph, ir::NodeId id) {
    const ir::Node node = graph[id];
    const ir::Op connective = distributes_over(node.op);
    if (connective == node.op) return id;
    const ir::Node inner = graph[node.operands.back()];
    if (inner.op != connective || !inner.has_future) return id;

    std::vector<ir::NodeId> present;  // these need no state of their own and stay together
    std::vector<ir::NodeId> parts;
    for (ir::NodeId operand : inner.operands) {
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

}  // namespace etlc::opt
