// Graph nodes as formulas, for comments in generated code and for --emit graph.
#include <fmt/format.h>

#include "ir/graph.hpp"

namespace etlc::ir {

namespace {

std::string interval_text(Interval interval) {
    if (interval == Interval{}) return "";
    if (!interval.bounded()) return fmt::format("[{}, inf]", interval.low);
    return fmt::format("[{}, {}]", interval.low, interval.high);
}

std::string atom_text(const Graph& graph, const Node& node) {
    const check::Model& model = graph.model();
    if (node.op == Op::constant_true) return "true";
    if (node.op == Op::constant_false) return "false";
    if (node.op == Op::flag) return (node.negated ? "!" : "") + model.inputs[node.index].name;
    const check::Predicate& predicate = model.predicates[node.index];
    if (!predicate.name.empty()) return (node.negated ? "!" : "") + predicate.name;
    const std::string words = predicate.text + predicate.threshold.text;
    return node.negated ? fmt::format("!({})", words) : fmt::format("({})", words);
}

std::string operand_text(const Graph& graph, NodeId id) {
    const Arity arity = info(graph[id].op).arity;
    const bool bare = arity == Arity::atom || arity == Arity::unary || graph[id].op == Op::trigger;
    return bare ? graph.text(id) : fmt::format("({})", graph.text(id));
}

std::string join(const Graph& graph, const Node& node) {
    std::string result;
    for (NodeId operand : node.operands) {
        if (!result.empty()) result += fmt::format(" {} ", info(node.op).symbol);
        result += operand_text(graph, operand);
    }
    return result;
}

}  // namespace

std::string Graph::text(NodeId id) const {
    const Node& node = nodes_[id];
    const OpInfo& row = info(node.op);
    switch (row.arity) {
        case Arity::atom: return atom_text(*this, node);
        case Arity::many: return join(*this, node);
        case Arity::unary:
            return fmt::format("{}{} {}", row.symbol, interval_text(node.interval), operand_text(*this, node.operands[0]));
        case Arity::binary: break;
    }
    const std::string left = operand_text(*this, node.operands[0]);
    const std::string right = operand_text(*this, node.operands[1]);
    if (node.op == Op::trigger)  // the language has no letter for it
        return fmt::format("!(!{} S{} !{})", left, interval_text(node.interval), right);
    return fmt::format("{} {}{} {}", left, row.symbol, interval_text(node.interval), right);
}

}  // namespace etlc::ir
