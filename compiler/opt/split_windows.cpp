// Splits windows over an unbounded future: into an equal formula in which bounded operators see an
// unbounded future only at the end of their window, and that step is pushed down to operands with a
// bounded future. rho is the same on every prefix, and bounds are at least as tight as the
// definition's.
//
// An automaton counts such windows down: F[0,40] (p U q) is 41 obligations, and under G it is sets
// of them. Split, only the unbounded operators form the automaton, over literals whose future is
// bounded. Which of the two is cheaper depends on both, so the plan chooses.
#include <algorithm>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "opt/opt.hpp"

namespace etlc::opt {

namespace {

using ir::Interval;
using ir::kUnbounded;
using ir::Node;
using ir::NodeId;
using ir::Op;
using ir::Span;

/// Formulas that need more parts are left as they are.
constexpr int kMostSteps = 2000;

/// The rules are written for U and F; with `seeks` false they apply to R and G, where U and R, &&
/// and ||, true and false change places. They hold for truth values at every position k of every
/// prefix 0..i, and so for min and max: both only compare. A formula is settled if its future is
/// bounded.
class Splitting {
public:
    explicit Splitting(ir::Graph& graph) : graph_(graph) {}

    /// Returns the formula itself if there is nothing to split, or if the parts would be too many.
    NodeId split(NodeId formula) {
        const NodeId result = rewrite(formula);
        return too_many() ? formula : result;
    }

private:
    /// Once true, every operator is left as it is.
    bool too_many() const { return steps_ > kMostSteps; }
    bool settled(NodeId id) const { return graph_[id].horizon != kUnbounded; }

    NodeId rewrite(NodeId id) {
        if (settled(id) || too_many()) return id;
        if (const auto known = done_.find(id); known != done_.end()) return known->second;
        const Node node = graph_[id];  // a copy: the graph grows meanwhile
        std::vector<NodeId> operands;
        for (NodeId operand : node.operands) operands.push_back(rewrite(operand));
        const NodeId result = rebuild(node, std::move(operands));
        done_.emplace(id, result);
        return result;
    }

    static Op wait(bool seeks) { return seeks ? Op::until : Op::release; }
    static Op either(bool seeks) { return seeks ? Op::disjunction : Op::conjunction; }
    static Op both(bool seeks) { return either(!seeks); }

    NodeId rebuild(const Node& node, std::vector<NodeId> operands) {
        if (ir::info(node.op).arity == ir::Arity::many)
            return combine(node.op, std::move(operands), node.span);
        const bool seeks = ir::takes_max(node.op);
        const NodeId left = operands.size() == 2 ? operands[0] : graph_.constant(seeks);
        return until(seeks, node.interval, left, operands.back(), node.span);
    }

    NodeId combine(Op op, std::vector<NodeId> operands, Span span) {
        ++steps_;
        if (too_many()) return operands.front();
        return graph_.combine(op, std::move(operands), span);
    }

    /// Builds left U[a,b] right.
    NodeId until(bool seeks, Interval interval, NodeId left, NodeId right, Span span) {
        ++steps_;
        if (too_many()) return right;
        if (interval.bounded() && !settled(right))
            if (const auto split = by_right(seeks, interval, left, right, span)) return *split;
        if (interval.bounded() && !settled(left))
            if (const auto split = by_left(seeks, interval, left, right, span)) return *split;
        return graph_.binary(wait(seeks), interval, left, right, span);
    }

    // ---- an unbounded future on the right

    std::optional<NodeId> by_right(bool seeks, Interval interval, NodeId left, NodeId right,
                                   Span span) {
        const Node node = graph_[right];
        if (left == graph_.constant(seeks) && interval.low == interval.high)
            return shift(seeks, interval.high, right, span);
        if (node.op == either(seeks)) {
            std::vector<NodeId> parts;
            for (NodeId part : node.operands)
                parts.push_back(until(seeks, interval, left, part, span));
            return combine(node.op, std::move(parts), span);
        }
        std::vector<NodeId> beside;
        NodeId chosen = right;
        if (node.op == both(seeks)) {
            beside = node.operands;
            const auto unsettled =
                std::find_if(beside.begin(), beside.end(), [&](NodeId o) { return !settled(o); });
            chosen = *unsettled;
            beside.erase(unsettled);
            if (graph_[chosen].op == either(seeks)) {  // s && (x || y): both alternatives
                std::vector<NodeId> parts;
                for (NodeId part : std::vector<NodeId>(graph_[chosen].operands))
                    parts.push_back(
                        until(seeks, interval, left, with(seeks, beside, part, span), span));
                return combine(either(seeks), std::move(parts), span);
            }
        }
        if (graph_[chosen].interval.bounded()) return std::nullopt;
        if (const auto simpler = from_now(chosen))
            return until(seeks, interval, left, with(seeks, beside, *simpler, span), span);
        return split(seeks, interval, left, beside, chosen, span);
    }

    NodeId with(bool seeks, std::vector<NodeId> beside, NodeId part, Span span) {
        beside.push_back(part);
        return combine(both(seeks), std::move(beside), span);
    }

    /// Reduces an operator over [c,inf] to one over [0,inf]: F[c,inf] q is F F[c,c] q, p U[c,inf] q
    /// is G[0,c-1] p && F[c,c] (p U q). Returns nothing where c is 0.
    std::optional<NodeId> from_now(NodeId id) {
        const Node x = graph_[id];
        if (x.interval.low == 0) return std::nullopt;
        const bool seeks = ir::takes_max(x.op);
        const std::uint32_t steps = x.interval.low;
        if (x.operands.size() == 1)  // kept apart, because the graph would merge the windows
            return graph_.keep(x.op, {}, {shift(seeks, steps, x.operands[0], x.span)}, x.span);
        const NodeId held =
            until(!seeks, {0, steps - 1}, graph_.constant(!seeks), x.operands[0], x.span);
        const NodeId there = shift(
            seeks, steps, graph_.binary(x.op, {}, x.operands[0], x.operands[1], x.span), x.span);
        return combine(both(seeks), {held, there}, x.span);
    }

    /// l U[a,b] (s && x) with x = p U q: the window's end is at e = k+b. Either q comes before e,
    /// then l U[a,b] (s && (p U[0,b-a] q)). Or x holds at e, and from some start on p lasts until
    /// e, which, as x holds there, is l U[a,b] (s && (q R[0,b-a] (p || q))). With x = p R q: either
    /// q is released before e, then l U[a,b] (s && (q U[0,b-a] (p && q))). Or x holds at e, which
    /// is no demand on a prefix that ends before, and from some start on q lasts until there: l
    /// U[a,b] (s && (p R[0,b-a] q)).
    NodeId split(bool seeks, Interval interval, NodeId left, const std::vector<NodeId>& beside,
                 NodeId x, Span span) {
        const Node node = graph_[x];
        const bool same = ir::takes_max(node.op) == seeks;
        const NodeId q = node.operands.back();
        const NodeId p =
            node.operands.size() == 2 ? node.operands[0] : graph_.constant(ir::takes_max(node.op));
        const Interval rest{0, interval.high - interval.low};
        const bool only = beside.empty() && left == graph_.constant(seeks);
        const auto start = [&](NodeId right) {
            return until(seeks, interval, left, with(seeks, beside, right, span), span);
        };
        const NodeId at_end = shift(same == seeks, interval.high, x, span);
        if (same && only) return combine(either(seeks), {start(q), at_end}, span);
        const NodeId strong = same ? q : combine(both(seeks), {p, q}, span);
        const NodeId early =
            only ? start(strong) : start(until(seeks, rest, same ? p : q, strong, node.span));
        const NodeId lasting =
            same ? until(!seeks, rest, q, combine(either(seeks), {p, q}, span), node.span)
                 : until(!seeks, rest, p, q, node.span);
        return combine(either(seeks), {early, combine(both(seeks), {at_end, start(lasting)}, span)},
                       span);
    }

    // ---- an unbounded future on the left

    /// l U[a,b] g is (g, where a = 0) || h U[a-1,b-1] (l && F[1,1] g): l at all positions before g
    /// is l at the last of them and h, what l demands of each position on the way, at the others.
    std::optional<NodeId> by_left(bool seeks, Interval interval, NodeId left, NodeId right,
                                  Span span) {
        if (interval.high == 0) return right;
        const auto held = on_the_way(seeks, left);
        if (!held) return std::nullopt;
        const NodeId last = combine(both(seeks), {left, shift(seeks, 1, right, span)}, span);
        const Interval before{interval.low == 0 ? 0 : interval.low - 1, interval.high - 1};
        const NodeId later = until(seeks, before, *held, last, span);
        return interval.low == 0 ? combine(either(seeks), {right, later}, span) : later;
    }

    /// Returns p || q for p U q, q for p R q, and that of each part for a conjunction.
    std::optional<NodeId> on_the_way(bool seeks, NodeId left) {
        if (settled(left)) return left;
        const Node node = graph_[left];
        if (node.op == both(seeks)) {
            std::vector<NodeId> parts;
            for (NodeId operand : node.operands) {
                const auto part = on_the_way(seeks, operand);
                if (!part) return std::nullopt;
                parts.push_back(*part);
            }
            return combine(node.op, std::move(parts), node.span);
        }
        if (ir::info(node.op).tense != ir::Tense::future || node.interval != Interval{})
            return std::nullopt;
        if (ir::takes_max(node.op) != seeks) return node.operands.back();
        const NodeId p = node.operands.size() == 2 ? node.operands[0] : graph_.constant(seeks);
        return combine(either(seeks), {p, node.operands.back()}, node.span);
    }

    // ---- single steps

    /// F[b,b] x. F[b,b] (p U q) is G[b,b] p U F[b,b] q, and F[b,b] (p R q) is (F[b,b] p R G[b,b] q)
    /// && F[b,b] q: the last part is what makes it false where the prefix ends before; for R[c,d]
    /// with c > 0 it is F[b,b] true.
    NodeId shift(bool seeks, std::uint32_t steps, NodeId operand, Span span) {
        ++steps_;
        if (too_many()) return operand;
        const Interval at{steps, steps};
        const Op one = seeks ? Op::eventually : Op::always;
        if (settled(operand)) return graph_.unary(one, at, operand, span);
        const Node x = graph_[operand];
        if (ir::info(x.op).arity == ir::Arity::many) {
            std::vector<NodeId> parts;
            for (NodeId part : x.operands) parts.push_back(shift(seeks, steps, part, span));
            return combine(x.op, std::move(parts), span);
        }
        const bool max = ir::takes_max(x.op);
        const NodeId right = shift(max, steps, x.operands.back(), span);
        const NodeId left =
            x.operands.size() == 2 ? shift(!max, steps, x.operands[0], span) : graph_.constant(max);
        const NodeId shifted =
            graph_.binary(x.op == Op::always || x.op == Op::release ? Op::release : Op::until,
                          x.interval, left, right, x.span);
        if (max == seeks) return shifted;
        const NodeId there = x.interval.low == 0
                                 ? shift(seeks, steps, x.operands.back(), span)
                                 : graph_.unary(one, at, graph_.constant(seeks), span);
        return combine(both(seeks), {shifted, there}, span);
    }

    ir::Graph& graph_;
    int steps_ = 0;
    std::unordered_map<NodeId, NodeId> done_;
};

}  // namespace

void split_windows(ir::Program& program) {
    ir::Graph& graph = program.graph;
    std::unordered_set<NodeId> seen;
    const auto visit = [&](const auto& self, NodeId id) -> void {
        if (!graph[id].has_future || !seen.insert(id).second) return;
        if (ir::info(graph[id].op).arity != ir::Arity::many) {
            const NodeId split = Splitting(graph).split(id);
            if (split != id) program.split_windows.emplace(id, split);
            return;
        }
        const std::vector<NodeId> operands = graph[id].operands;  // the graph grows meanwhile
        for (NodeId operand : operands) self(self, operand);
    };
    for (std::size_t m = 0; m < program.monitors.size(); ++m)
        if (!graph.model().monitors[m].sliding) visit(visit, program.monitors[m]);
}

}  // namespace etlc::opt
