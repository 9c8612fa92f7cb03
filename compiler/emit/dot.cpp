// Prints the formulas as a Graphviz graph.
#include <set>

#include "emit/emit.hpp"
#include "emit/text/printer.hpp"
#include "source/text.hpp"

namespace etlc::emit {

namespace {

std::string label(const ir::Graph& graph, ir::NodeId id) {
    const ir::Node& node = graph[id];
    if (ir::info(node.op).arity == ir::Arity::atom) return graph.text(id);
    std::string text = ir::info(node.op).symbol;
    if (node.interval.bounded())
        text += fmt::format("[{}, {}]", node.interval.low, node.interval.high);
    else if (node.interval.low > 0)
        text += fmt::format("[{}, inf]", node.interval.low);
    return text;
}

void print_node(Printer& out, const ir::Graph& graph, ir::NodeId id, std::set<ir::NodeId>& done) {
    if (!done.insert(id).second) return;
    const bool atom = ir::info(graph[id].op).arity == ir::Arity::atom;
    out.line("n{} [label={}{}];", id, source::dot_string(label(graph, id)),
             atom ? ", shape=box" : "");
    for (ir::NodeId operand : graph[id].operands) {
        print_node(out, graph, operand, done);
        out.line("n{} -> n{};", id, operand);
    }
}

}  // namespace

std::string dot(const plan::Plan& plan, const Options&) {
    Printer out;
    out.open(fmt::format("digraph {} {{", plan.model->name));
    out.line("node [fontname=\"monospace\"];");
    std::set<ir::NodeId> done;
    for (std::size_t m = 0; m < plan.monitors.size(); ++m) {
        const plan::Monitor& monitor = plan.monitors[m];
        const ir::NodeId root = monitor.node;
        out.line("m{} [label=\"{}{}\", shape=plaintext];", m, monitor.sliding ? "sliding " : "",
                 monitor.name);
        print_node(out, *plan.formulas, root, done);
        out.line("m{} -> n{};", m, root);
    }
    out.close();
    return out.take();
}

}  // namespace etlc::emit
