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

/// At t the choice among [t + low, t + high], cut at the end. `endless`: the last element stands
/// for all that come after it, too.
Column window(const Column& operand, std::uint64_t low, std::uint64_t high, Choice choose,
              bool endless) {
    const std::size_t n = operand.size();
    Column result(n, choose.of_nothing());
    std::deque<std::size_t> chosen;  // from the last position to the first, each beating the next
    for (std::size_t t = n; t-- > 0;) {
        if (low >= n - t && !endless) continue;
        const std::size_t entering = std::min<std::uint64_t>(t + low, n - 1);
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
/// f U g && F[0,w] g, and f U[a,b] g asks f for a steps and then f U[0,b-a] g. `endless`: of g.
Column until(Column f, const Column& g, std::uint64_t low, std::uint64_t high, Choice choose,
             bool endless) {
    const std::size_t n = g.size();
    const Choice join = choose.dual();
    Column inner = window(g, 0, high == check::kUnbounded ? high : high - low, choose, endless);
    Sourced unbounded = choose.of_nothing();
    for (std::size_t t = n; t-- > 0;) {
        unbounded = choose(g[t], join(f[t], unbounded));
        inner[t] = join(inner[t], unbounded);
    }
    if (low == 0) return inner;
    if (endless) f.back() = join.of_nothing();  // f is asked for where it has been seen
    const Column before = window(f, 0, low - 1, join, false);
    Column result(n, choose.of_nothing());
    for (std::size_t t = 0; t < n; ++t)
        if (low < n - t || endless)
            result[t] = join(before[t], inner[std::min<std::uint64_t>(t + low, n - 1)]);
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
               const Observations& observations, std::uint64_t last, End end, Reading reading,
               const std::optional<Altered>& altered)
    : graph_(&graph),
      observations_(&observations),
      atoms_(observations.atoms().size()),
      seen_(last + 1),
      end_(end),
      reading_(reading),
      values_(nodes.size()) {
    for (NodeId id = 0; id < nodes.size(); ++id) {
        if (!nodes[id]) continue;
        const ir::Node& node = graph[id];
        switch (ir::info(node.op).arity) {
            case ir::Arity::atom: values_[id] = leaf(node, altered); break;
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
    if (sample / atoms_ >= seen_) return std::nullopt;
    return Sample{static_cast<Index>(sample % atoms_), sample / atoms_};
}

Sourced Values::constant_or_literal(const ir::Node& node, std::size_t step,
                                    const std::optional<Altered>& altered) const {
    if (node.op == ir::Op::constant_true) return kTrueItself;
    if (node.op == ir::Op::constant_false) return kFalseItself;
    const Index atom = observations_->atom(node.op == ir::Op::predicate, node.index);
    const bool is_altered = altered && altered->step == step && altered->is_of(atom);
    const etlmon::Value value = step == seen_ ? observations_->range(atom)
                                : is_altered  ? observations_->value(atom, altered->measured)
                                              : observations_->value({atom, step});
    const bool low = (end_ == End::low) != node.negated;
    const Sourced found = sourced(low ? value.low : value.high, step * atoms_ + atom);
    return node.negated ? -found : found;
}

Column Values::leaf(const ir::Node& node, const std::optional<Altered>& altered) const {
    Column result(seen_ + (is_for_good() ? 1 : 0));
    for (std::size_t step = 0; step < result.size(); ++step)
        result[step] = constant_or_literal(node, step, altered);
    return result;
}

Sourced Values::combined(const ir::Node& node, std::size_t position) const {
    const Choice choose{node.op == ir::Op::disjunction};
    Sourced result = values_[node.operands.front()][position];
    for (const NodeId operand : node.operands) result = choose(result, values_[operand][position]);
    return result;
}

Column Values::combination(const ir::Node& node) const {
    Column result(values_[node.operands.front()].size());
    for (std::size_t t = 0; t < result.size(); ++t) result[t] = combined(node, t);
    return result;
}

Column Values::temporal(const ir::Node& node) const {
    const Choice choose{ir::takes_max(node.op)};
    const bool past = ir::info(node.op).tense == ir::Tense::past;
    // What may come counts where it may turn the bound: a max may grow, a min may fall.
    const bool endless = is_for_good() && !past && choose.max == (end_ == End::high);
    // The past is the future of the trace backwards.
    const auto in_order = [&](Column column) {
        column.resize(endless ? seen_ + 1 : seen_);
        if (past) std::reverse(column.begin(), column.end());
        return column;
    };
    const Column last = in_order(values_[node.operands.back()]);
    const auto [low, high] = node.interval;
    Column result =
        in_order(node.operands.size() == 1 ? window(last, low, high, choose, endless)
                                           : until(in_order(values_[node.operands.front()]), last,
                                                   low, high, choose, endless));
    result.resize(seen_);
    if (is_for_good()) result.push_back(unseen(node));
    return result;
}

/// The lowest or highest unseen value of a temporal operator, as docs/semantics.md has them.
Sourced Values::unseen(const ir::Node& node) const {
    const Choice choose{ir::takes_max(node.op)};
    const bool past = ir::info(node.op).tense == ir::Tense::past;
    const bool moves = choose.max == (end_ == End::high);
    const Column& operand = values_[node.operands.back()];
    if (!moves && node.interval.low > 0) return choose.of_nothing();
    const bool never_forgets = node.operands.size() == 1 && !node.interval.bounded();
    Sourced result = operand.back();
    if (past && (moves || never_forgets))
        for (const Sourced& known : operand) result = choose(result, known);
    return result;
}

// ---- with other measurements --------------------------------------------------------------------

Sourced Values::at_with(const Altered& altered, NodeId node, std::uint64_t position) {
    changed_.resize(node + std::size_t{1});
    for (NodeId id = 0; id <= node; ++id)
        if (has(id)) alter(id, altered);
    const Sourced result = at(node, position);
    for (; !before_.empty(); before_.pop_back()) {
        const Before& was = before_.back();
        values_[was.node][was.position] = was.value;
        changed_[was.node].clear();
    }
    return result;
}

void Values::set(NodeId node, std::size_t position, Sourced value) {
    Sourced& now = values_[node][position];
    if (now == value) return;
    before_.push_back({node, position, now});
    changed_[node].push_back(position);
    now = value;
}

/// Its operands are altered.
void Values::alter(NodeId id, const std::optional<Altered>& altered) {
    const ir::Node& node = (*graph_)[id];
    switch (ir::info(node.op).arity) {
        case ir::Arity::atom:
            return set(id, altered->step, constant_or_literal(node, altered->step, altered));
        case ir::Arity::many:
            for (const NodeId operand : node.operands)
                for (const std::size_t position : changed_[operand])
                    set(id, position, combined(node, position));
            return;
        case ir::Arity::unary:
        case ir::Arity::binary: break;
    }
    if (std::all_of(node.operands.begin(), node.operands.end(),
                    [&](NodeId operand) { return changed_[operand].empty(); }))
        return;
    const Column column = temporal(node);
    for (std::size_t t = 0; t < column.size(); ++t) set(id, t, column[t]);
}

}  // namespace etlc::explain
