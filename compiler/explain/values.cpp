#include "explain/values.hpp"

#include <algorithm>
#include <cstddef>
#include <deque>

namespace etlc::explain {

namespace {

using Column = std::vector<Sourced>;

constexpr std::int64_t kFirst = std::int64_t{1} << 62;

Sourced sourced(etlmon::Key key, std::uint64_t sample) {
    const std::int64_t rank = kFirst - static_cast<std::int64_t>(sample);
    return {key, key < 0 ? -rank : rank};
}

/// Max, or min in its place.
struct Choice {
    bool max = true;

    Sourced operator()(Sourced a, Sourced b) const { return max == (a < b) ? b : a; }
    Sourced of_nothing() const { return max ? kFalseItself : kTrueItself; }
    Choice dual() const { return {!max}; }
};

/// At t the choice among [t + low, t + high], cut at the end.
Column window(const Column& operand, std::uint64_t low, std::uint64_t high, Choice choose) {
    const std::size_t n = operand.size();
    Column result(n, choose.of_nothing());
    std::deque<std::size_t> chosen;  // from the last position to the first, each beating the next
    for (std::size_t t = n; t-- > 0;) {
        if (low >= n - t) continue;
        const std::size_t entering = t + low;
        while (!chosen.empty() &&
               choose(operand[chosen.back()], operand[entering]) == operand[entering])
            chosen.pop_back();
        chosen.push_back(entering);
        while (chosen.front() - t > high) chosen.pop_front();
        result[t] = operand[chosen.front()];
    }
    return result;
}

/// f U[low, high] g for a max, f R[low, high] g for a min. As on every trace, f U[0,w] g is
/// f U g && F[0,w] g, and f U[a,b] g asks f for a steps and then f U[0,b-a] g.
Column until(const Column& f, const Column& g, std::uint64_t low, std::uint64_t high,
             Choice choose) {
    const std::size_t n = g.size();
    const Choice join = choose.dual();
    Column inner = window(g, 0, high == check::kUnbounded ? high : high - low, choose);
    Sourced unbounded = choose.of_nothing();
    for (std::size_t t = n; t-- > 0;) {
        unbounded = choose(g[t], join(f[t], unbounded));
        inner[t] = join(inner[t], unbounded);
    }
    if (low == 0) return inner;
    const Column before = window(f, 0, low - 1, join);
    Column result(n, choose.of_nothing());
    for (std::size_t t = 0; low < n - t; ++t) result[t] = join(before[t], inner[t + low]);
    return result;
}

}  // namespace

std::vector<bool> closure(const ir::Graph& graph, const std::vector<NodeId>& roots) {
    std::vector<bool> result(graph.size());
    for (const NodeId root : roots) result[root] = true;
    for (std::size_t id = graph.size(); id-- > 0;)
        if (result[id])
            for (const NodeId operand : graph[static_cast<NodeId>(id)].operands)
                result[operand] = true;
    return result;
}

Values::Values(const ir::Graph& graph, const std::vector<bool>& nodes,
               const Observations& observations, std::uint64_t last, End end,
               const std::optional<Altered>& altered)
    : atoms_(observations.atoms().size()), length_(last + 1), values_(nodes.size()) {
    for (NodeId id = 0; id < nodes.size(); ++id) {
        if (!nodes[id]) continue;
        const ir::Node& node = graph[id];
        switch (ir::info(node.op).arity) {
            case ir::Arity::atom: values_[id] = literal(node, observations, end, altered); break;
            case ir::Arity::many: values_[id] = combination(node); break;
            case ir::Arity::unary:
            case ir::Arity::binary: values_[id] = temporal(node); break;
        }
    }
}

std::optional<Sample> Values::source(Sourced value) const {
    const std::int64_t rank = value.rank < 0 ? -value.rank : value.rank;
    if (rank > kFirst) return std::nullopt;
    const auto sample = static_cast<std::uint64_t>(kFirst - rank);
    return Sample{static_cast<Index>(sample % atoms_), sample / atoms_};
}

Column Values::literal(const ir::Node& node, const Observations& observations, End end,
                       const std::optional<Altered>& altered) const {
    if (node.op == ir::Op::constant_true) return Column(length_, kTrueItself);
    if (node.op == ir::Op::constant_false) return Column(length_, kFalseItself);
    const Index atom = observations.atom(node.op == ir::Op::predicate, node.index);
    Column result(length_);
    for (std::size_t step = 0; step < length_; ++step) {
        const bool other =
            altered && altered->step == step &&
            std::find(altered->atoms.begin(), altered->atoms.end(), atom) != altered->atoms.end();
        const etlmon::Value value =
            other ? observations.value(atom, altered->measured) : observations.value({atom, step});
        const bool low = (end == End::low) != node.negated;
        const Sourced found = sourced(low ? value.low : value.high, step * atoms_ + atom);
        result[step] = node.negated ? -found : found;
    }
    return result;
}

Column Values::combination(const ir::Node& node) const {
    const Choice choose{node.op == ir::Op::disjunction};
    Column result = values_[node.operands.front()];
    for (const NodeId operand : node.operands)
        for (std::size_t t = 0; t < length_; ++t)
            result[t] = choose(result[t], values_[operand][t]);
    return result;
}

Column Values::temporal(const ir::Node& node) const {
    const Choice choose{ir::takes_max(node.op)};
    const bool past = ir::info(node.op).tense == ir::Tense::past;
    // The past is the future of the trace backwards.
    const auto in_order = [&](Column column) {
        if (past) std::reverse(column.begin(), column.end());
        return column;
    };
    const Column last = in_order(values_[node.operands.back()]);
    const auto [low, high] = node.interval;
    if (node.operands.size() == 1) return in_order(window(last, low, high, choose));
    return in_order(until(in_order(values_[node.operands.front()]), last, low, high, choose));
}

}  // namespace etlc::explain
