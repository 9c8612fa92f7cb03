#include "opt/opt.hpp"

#include <unordered_map>

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

}  // namespace etlc::opt
