// Prints graph nodes as formulas, for comments in generated code and for --emit graph.
#include <fmt/format.h>

#include "check/model/elision.hpp"
#include "ir/lower.hpp"

namespace etlc::ir {

namespace {

std::string interval_text(Interval interval) {
    if (interval == Interval{}) return "";
    const std::string high = interval.bounded() ? std::to_string(interval.high) : "inf";
    return '[' + std::to_string(interval.low) + ", " + high + ']';
}

/// Prints the operator as in the language: "F[0, 3]", "X", "Y".
std::string operator_text(const Node& node) {
    const bool one_step = node.interval == Interval{1, 1};
    if (node.op == Op::eventually && one_step) return "X";
    if (node.op == Op::once && one_step) return "Y";
    if (counts(node.op))
        return fmt::format("{}({}){}", info(node.op).symbol, node.index,
                           interval_text(node.interval));
    return info(node.op).symbol + interval_text(node.interval);
}

std::string atom_text(const Graph& graph, const Node& node) {
    const check::Model& model = graph.model();
    if (node.op == Op::constant_true) return "true";
    if (node.op == Op::constant_false) return "false";
    if (node.op == Op::flag) return (node.negated ? "!" : "") + model.inputs[node.index].name;
    const check::Predicate& predicate = model.predicates[node.index];
    if (!predicate.name.empty()) return (node.negated ? "!" : "") + predicate.name;
    const std::string words = predicate.text + predicate.threshold.text;
    return (node.negated ? "!(" : "(") + words + ')';
}

/// Returns whether a formula needs no brackets as an operand; trigger, which the language lacks,
/// brings its own.
bool is_bare(const Node& node) {
    const Arity arity = info(node.op).arity;
    return arity == Arity::atom || arity == Arity::unary || node.op == Op::trigger;
}

check::Phrase phrase(const Graph& graph, NodeId id) {
    const Node& node = graph[id];
    check::Phrase result;
    for (NodeId operand : node.operands)
        result.operands.push_back({operand, !is_bare(graph[operand])});
    switch (info(node.op).arity) {
        case Arity::atom: result.opening = atom_text(graph, node); break;
        case Arity::unary: result.opening = operator_text(node) + ' '; break;
        case Arity::binary:
        case Arity::many: result.separator = ' ' + operator_text(node) + ' '; break;
    }
    if (node.op == Op::trigger) {
        result.opening = "!(!";
        result.separator = " S" + interval_text(node.interval) + " !";
        result.closing = ")";
    }
    if (counts(node.op))
        return {.opening = "count(",
                .operands = {{node.counted, false}},
                .closing = fmt::format(", {} steps) {} {}", node.interval.high + 1,
                                       takes_max(node.op) ? ">=" : "<", node.index)};
    return result;
}

void mark(const Graph& graph, NodeId id, std::vector<bool>& reached) {
    if (reached[id]) return;
    reached[id] = true;
    for (NodeId operand : graph[id].operands) mark(graph, operand, reached);
}

/// Prints a definition: "n7 = F[0, 3] n2".
std::string definition(const Graph& graph, NodeId id) {
    const Node& node = graph[id];
    if (info(node.op).arity == Arity::atom) return fmt::format("n{} = {}\n", id, graph.text(id));
    std::string operands;
    for (NodeId operand : node.operands) operands += fmt::format(" n{}", operand);
    return fmt::format("n{} = {}{}  // {}\n", id, operator_text(node), operands, graph.text(id));
}

}  // namespace

std::string print(const Program& program) {
    const Graph& graph = program.graph;
    std::vector<bool> reached(graph.size(), false);
    for (NodeId root : program.monitors) mark(graph, root, reached);
    for (NodeId root : program.lets)
        if (root != check::kNone) mark(graph, root, reached);
    std::string text = fmt::format("graph {}\n", graph.model().name);
    for (NodeId id = 0; id < graph.size(); ++id)
        if (reached[id]) text += "  " + definition(graph, id);
    for (std::size_t m = 0; m < program.monitors.size(); ++m)
        text += fmt::format("  {} = n{}\n", graph.model().monitors[m].name, program.monitors[m]);
    for (std::size_t i = 0; i < program.lets.size(); ++i)
        if (program.lets[i] != check::kNone)
            text += fmt::format("  let {} = n{}\n", graph.model().lets[i].name, program.lets[i]);
    return text;
}

std::string Graph::text(NodeId id) const {
    return check::elided_text(id, [this](NodeId node) { return phrase(*this, node); });
}

std::string Graph::short_text(NodeId id) const {
    return check::short_text(id, [this](NodeId node) { return phrase(*this, node); });
}

}  // namespace etlc::ir
