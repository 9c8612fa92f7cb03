#include "ir/graph.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>

#include "check/model/elision.hpp"
#include "ir/lower.hpp"

namespace etlc::ir {

namespace {

constexpr std::array kOperators = {
#define OPERATOR(name, symbol, arity, tense, dual) \
    OpInfo{#name, symbol, Arity::arity, Tense::tense, Op::dual},
#include "ir/operators.def"
#undef OPERATOR
};

std::size_t mix(std::size_t seed, std::size_t value) {
    return seed ^ (value + 0x9e3779b97f4a7c15ULL + (seed << 6U) + (seed >> 2U));
}

std::size_t hash(const Node& node) {
    std::size_t result =
        mix(static_cast<std::size_t>(node.op), static_cast<std::size_t>(node.negated));
    result = mix(mix(result, node.index), mix(node.interval.low, node.interval.high));
    for (NodeId operand : node.operands) result = mix(result, operand);
    return result;
}

/// Adds steps; unbounded where either is, or on overflow.
std::uint32_t add_steps(std::uint32_t a, std::uint32_t b) {
    return a == kUnbounded || b == kUnbounded || a > kUnbounded - 1 - b ? kUnbounded : a + b;
}

}  // namespace

const OpInfo& info(Op op) {
    return kOperators[static_cast<std::size_t>(op)];
}

bool takes_max(Op op) {
    return op == Op::eventually || op == Op::until || op == Op::once || op == Op::since ||
           op == Op::at_least;
}

bool counts(Op op) {
    return op == Op::at_least || op == Op::all_but;
}

bool Node::same_as(const Node& other) const {
    return op == other.op && negated == other.negated && index == other.index &&
           interval == other.interval && operands == other.operands;
}

Graph::Graph(const check::Model& model) : model_(&model) {
    intern({.op = Op::constant_true});
    intern({.op = Op::constant_false});
}

NodeId Graph::intern(Node node) {
    std::vector<NodeId>& bucket = by_hash_[hash(node)];
    for (NodeId id : bucket)
        if (nodes_[id].same_as(node)) return id;

    const bool future = info(node.op).tense == Tense::future;
    node.has_future = future;
    node.unbounded_past = info(node.op).tense == Tense::past && !node.interval.bounded();
    for (NodeId operand : node.operands) {
        node.has_future |= nodes_[operand].has_future;
        node.unbounded_past |= nodes_[operand].unbounded_past;
        node.horizon = std::max(node.horizon, nodes_[operand].horizon);
    }
    if (future) node.horizon = add_steps(node.horizon, node.interval.high);

    const auto id = static_cast<NodeId>(nodes_.size());
    nodes_.push_back(std::move(node));
    bucket.push_back(id);
    return id;
}

NodeId Graph::literal(Op op, Index index, bool negated, Span span) {
    return intern({.op = op, .negated = negated, .index = index, .span = span});
}

/// Drops operands that another one makes redundant: a && (a || b) is a, and dually.
std::vector<NodeId> Graph::absorb(Op op, std::vector<NodeId> operands) const {
    const Op dual = info(op).dual;
    const auto absorbed = [&](NodeId candidate) {
        const Node& node = nodes_[candidate];
        return node.op == dual &&
               std::any_of(node.operands.begin(), node.operands.end(), [&](NodeId part) {
                   return std::binary_search(operands.begin(), operands.end(), part);
               });
    };
    std::vector<NodeId> kept;
    std::copy_if(operands.begin(), operands.end(), std::back_inserter(kept),
                 [&](NodeId id) { return !absorbed(id); });
    return kept;
}

NodeId Graph::combine(Op op, std::vector<NodeId> operands, Span span) {
    assert(op == Op::conjunction || op == Op::disjunction);
    const NodeId neutral = constant(op == Op::conjunction);
    const NodeId dominant = constant(op == Op::disjunction);
    std::vector<NodeId> flat;
    for (NodeId id : operands) {
        if (nodes_[id].op == op)
            flat.insert(flat.end(), nodes_[id].operands.begin(), nodes_[id].operands.end());
        else if (id != neutral)
            flat.push_back(id);
    }
    std::sort(flat.begin(), flat.end());
    flat.erase(std::unique(flat.begin(), flat.end()), flat.end());
    if (std::binary_search(flat.begin(), flat.end(), dominant)) return dominant;
    flat = absorb(op, std::move(flat));
    if (flat.empty()) return neutral;
    if (flat.size() == 1) return flat.front();
    return intern({.op = op, .operands = std::move(flat), .span = span});
}

// The laws below hold position by position on every prefix. Note that F[1,b] true is not true: it
// is false at the last step.
NodeId Graph::unary(Op op, Interval interval, NodeId operand, Span span) {
    const bool max = takes_max(op);
    const NodeId empty = constant(!max);
    if (operand == empty) return empty;
    if (interval.low == 0 && (interval.high == 0 || operand == constant(max))) return operand;
    const Node& inner = nodes_[operand];
    if (inner.op == op) {  // F[a,b] F[c,d] f is F[a+c,b+d] f: every position of the sum is reached
                           // through one in between
        const std::uint32_t low = add_steps(interval.low, inner.interval.low);
        const std::uint32_t high = add_steps(interval.high, inner.interval.high);
        // An unbounded O at the present never falls below what it has seen, which its bounds use:
        // it stays around O[1,b].
        const bool remembers =
            interval == Interval{} && inner.interval.low > 0 && info(op).tense == Tense::past;
        const bool exact = !remembers && low <= check::kMaxBound &&
                           (high != kUnbounded || !interval.bounded() || !inner.interval.bounded());
        if (exact) return unary(op, {low, high}, inner.operands.front(), span);
    }
    return intern({.op = op, .interval = interval, .operands = {operand}, .span = span});
}

NodeId Graph::count(Op op, std::uint32_t n, std::uint32_t high, NodeId operand, Counted counted,
                    Span span) {
    const bool max = takes_max(op);
    if (n == 1) return unary(max ? Op::once : Op::historically, {0, high}, operand, span);
    if (operand == constant(!max)) return operand;
    return intern({.op = op,
                   .index = n,
                   .interval = {0, high},
                   .operands = {operand},
                   .span = span,
                   .counted = counted});
}

NodeId Graph::binary(Op op, Interval interval, NodeId left, NodeId right, Span span) {
    const bool max = takes_max(op);
    const bool future = info(op).tense == Tense::future;
    const NodeId empty = constant(!max);
    if (right == empty) return empty;
    if (interval.low == 0 && (interval.high == 0 || right == constant(max) || left == empty))
        return right;
    if (interval.low == 0 && left == right)
        return right;                 // f U f: f now is all it takes, and it takes f now
    if (left == empty) return empty;  // the left side breaks before the window opens
    if (left == constant(max)) {
        const Op one =
            future ? (max ? Op::eventually : Op::always) : (max ? Op::once : Op::historically);
        return unary(one, interval, right, span);
    }
    return intern({.op = op, .interval = interval, .operands = {left, right}, .span = span});
}

NodeId Graph::keep(Op op, Interval interval, std::vector<NodeId> operands, Span span) {
    return intern({.op = op, .interval = interval, .operands = std::move(operands), .span = span});
}

void verify(const Graph& graph) {
    for (NodeId id = 0; id < graph.size(); ++id) {
        const Node& node = graph[id];
        const Arity arity = info(node.op).arity;
        const bool literal = node.op == Op::predicate || node.op == Op::flag;
        assert(literal || !node.negated);
        assert(arity != Arity::atom || node.operands.empty());
        assert(arity != Arity::unary || node.operands.size() == 1);
        assert(arity != Arity::binary || node.operands.size() == 2);
        assert(arity != Arity::many || node.operands.size() >= 2);
        assert(node.interval.low <= node.interval.high);
        assert(arity != Arity::many || std::is_sorted(node.operands.begin(), node.operands.end()));
        for ([[maybe_unused]] NodeId operand : node.operands) assert(operand < id);
        (void)literal;
        (void)arity;
    }
}

// Prints graph nodes as formulas, for comments in generated code and for --emit graph.

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
    if (counts(node.op)) {
        const std::uint32_t steps = node.interval.high + 1;
        const bool each_step = node.counted.each_step;
        return {.opening = each_step ? "fraction(" : "count(",
                .operands = {{node.counted.formula, false}},
                .closing = fmt::format(
                    ", {} steps) {} {}", steps, takes_max(node.op) ? ">=" : "<",
                    each_step ? check::share_text(node.index, steps) : std::to_string(node.index))};
    }
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
