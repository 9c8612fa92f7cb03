// Prints --emit report: the figures of the head of the file, and those of each part.

#include <set>

#include "check/formulas/horizons.hpp"
#include "diag/diag.hpp"
#include "emit/context.hpp"
#include "emit/emit.hpp"
#include "emit/text/layout.hpp"
#include "emit/text/printer.hpp"
#include "source/text.hpp"

namespace etlc::emit {

namespace {

using check::Index;

std::string unknown_for(const plan::Monitor& monitor, const check::Gap& gap) {
    if (gap.inputs.empty()) return "never";
    if (gap.steps != check::Gap::kForGood)
        return fmt::format("for up to {}", diag::counted(gap.steps, "step"));
    switch (monitor.restarts) {
        case check::Restarts::never: break;
        case check::Restarts::on_request: return "until it is restarted";
        case check::Restarts::when_final:
            if (monitor.ahead == plan::kUnbounded) return "for good: no final verdict, no restart";
            return fmt::format("for {} at most, until the next cycle",
                               diag::counted(monitor.ahead + std::uint64_t{1}, "step"));
    }
    return "for good";
}

/// Prints how long a missing sample may leave each verdict unknown.
void print_gaps(Printer& out, const plan::Plan& plan) {
    const std::vector<check::Gap> gaps = check::gaps(*plan.model);
    std::vector<Row> rows{{"monitor", "a missing sample of", "may leave it unknown"}};
    for (const plan::Monitor& monitor : plan.monitors) {
        const check::Gap& gap = gaps[monitor.index];
        std::string inputs;
        for (const Index input : gap.inputs)
            inputs += (inputs.empty() ? "" : ", ") + plan.model->inputs[input].name;
        rows.push_back({monitor.name, inputs, unknown_for(monitor, gap)});
    }
    out.line();
    print_table(out, "  ", rows, 3);
}

}  // namespace

std::string report(const plan::Plan& plan, const Options& options) {
    const ir::Graph& graph = *plan.formulas;
    Printer out;
    out.line("spec {}", plan.model->name);
    print_figures(out, "  ", plan,
                  options.targets_file.empty() ? "the file of targets" : options.targets_file);
    print_gaps(out, plan);
    out.line();
    out.line("estimated code: {} bytes, targets aside", plan.cost.code_bytes);
    if (plan.cost.stack_bytes > 0)
        out.line("arrays on the stack of a step: {} bytes, for {}", plan.cost.stack_bytes,
                 plan::what_takes_stack(plan));
    out.line();
    std::vector<Row> rows{{"part", "as", "state B", "code B", "operations"}};
    for (const Index p : plan.pasts) {
        const check::Past& past = plan.model->pasts[p];
        const plan::Cost cost = plan::cost_of(past);
        rows.push_back({shortened(past.text), "number", number(cost.state_bytes),
                        number(cost.code_bytes), number(cost.operations)});
    }
    for (const plan::Reading& reading : plan.readings) {
        const plan::Cost cost = plan::cost_of(reading, plan.values);
        rows.push_back({shortened(graph.text(reading.node)), reading.as, number(cost.state_bytes),
                        number(cost.code_bytes), number(cost.operations)});
    }
    for (const plan::Stream& stream : plan.streams) {
        const plan::Cost cost = plan::cost_of(stream, plan.values);
        if (cost.operations == 0 && cost.state_bytes == 0) continue;
        const std::string text = plan::text_of(stream, graph);
        rows.push_back({text.empty() ? "(in between)" : shortened(text), "stream",
                        number(cost.state_bytes), number(cost.code_bytes),
                        number(cost.operations)});
    }
    if (rows.size() > 1) print_table(out, "  ", rows, 2);
    return out.take();
}

// Prints the formulas as a Graphviz graph.

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
