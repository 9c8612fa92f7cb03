#include "reference/normal_form.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace etlc::reference {
namespace {

using check::Formula;
using FormulaKind = Formula::Kind;
using NodeKind = Node::Kind;

class Builder {
public:
    explicit Builder(const check::Model& model) : model_(model) {}

    Index build(Index formula, bool negated) {
        const auto key = std::pair(formula, negated);
        if (const auto found = made_.find(key); found != made_.end()) return found->second;
        const Index node = make(model_.formulas[formula], negated);
        made_.emplace(key, node);
        return node;
    }

    std::vector<Node> take() { return std::move(nodes_); }

private:
    const check::Model& model_;
    std::vector<Node> nodes_;
    std::map<std::pair<Index, bool>, Index> made_;

    Index add(Node node) {
        nodes_.push_back(std::move(node));
        return static_cast<Index>(nodes_.size() - 1);
    }

    Index literal(NodeKind kind, bool negated, Index index = 0) {
        return add({.kind = kind, .negated = negated, .index = index, .operands = {}});
    }

    /// Adds || of the operands, or && if `all`.
    Index connect(bool all, std::vector<Index> operands) {
        return add({.kind = NodeKind::any, .negated = all, .operands = std::move(operands)});
    }

    Index connective(const Formula& f, bool negated, bool all) {
        std::vector<Index> operands;
        for (const Index operand : f.operands) operands.push_back(build(operand, negated));
        return connect(all != negated, std::move(operands));
    }

    /// Adds an operator, or its dual; negation turns the one into the other over negated operands.
    Index temporal(const Formula& f, bool negated, NodeKind kind, bool dual = false) {
        Node node{.kind = kind, .negated = dual != negated, .low = f.low, .high = f.high};
        for (const Index operand : f.operands) node.operands.push_back(build(operand, negated));
        return add(std::move(node));
    }

    /// Adds `f -> g` as `!f || g`; its negation is `f && !g`.
    Index implication(Index f, Index g, bool negated) {
        const Index left = build(f, !negated);
        return connect(negated, {left, build(g, negated)});
    }

    /// Adds `f <-> g` as `(f -> g) && (g -> f)`; its negation is `!(f -> g) || !(g -> f)`.
    Index equivalence(Index f, Index g, bool negated) {
        const Index forth = implication(f, g, negated);
        return connect(!negated, {forth, implication(g, f, negated)});
    }

    /// Adds `f W g` as `g R (f || g)`; its negation is `!g U (!f && !g)`.
    Index weak_until(Index f, Index g, bool negated) {
        const Index left = build(f, negated);
        const Index right = build(g, negated);
        const Index both = connect(negated, {left, right});
        return add({.kind = NodeKind::until, .negated = !negated, .operands = {right, both}});
    }

    /// Adds O[steps,steps] of the operand, or H[steps,steps] if `all`.
    Index before(std::uint32_t steps, bool all, Index operand) {
        return add({.kind = NodeKind::once,
                    .negated = all,
                    .operands = {operand},
                    .low = steps,
                    .high = steps});
    }

    /// Adds `rise f` as `f && Y !f`, and `fall f` as `!f && Y f`; the negation of either is the
    /// dual.
    Index edge(Index f, bool falls, bool negated) {
        const Index now = build(f, falls != negated);
        return connect(!negated, {now, before(1, negated, build(f, falls == negated))});
    }

    /// Adds `held[n] f` as `H[0,n] f && O[n,n] true`; its negation is `O[0,n] !f || H[n,n] false`.
    Index held(const Formula& f, bool negated) {
        const Index all = temporal(f, negated, NodeKind::once, true);
        return connect(!negated,
                       {all, before(f.high, negated, literal(NodeKind::constant, negated))});
    }

    /// Adds `count(f, n) >= k`: `rise f` at k or more of the last n positions; `k = 1` is
    /// `O[0, n - 1] rise f`. `fraction(f, n) >= k / n`: `f` at as many.
    Index count(const Formula& f, bool negated) {
        const Index counted =
            f.each_step ? build(f.operands[0], negated) : edge(f.operands[0], false, negated);
        return add({.kind = f.index == 1 ? NodeKind::once : NodeKind::at_least,
                    .negated = negated,
                    .index = f.index,
                    .operands = {counted},
                    .high = f.high});
    }

    Index make(const Formula& f, bool negated) {
        switch (f.kind) {
            case FormulaKind::constant_true: return literal(NodeKind::constant, negated);
            case FormulaKind::constant_false: return literal(NodeKind::constant, !negated);
            case FormulaKind::predicate: return literal(NodeKind::predicate, negated, f.index);
            case FormulaKind::boolean_input: return literal(NodeKind::boolean, negated, f.index);
            case FormulaKind::negation: return build(f.operands[0], !negated);
            case FormulaKind::conjunction: return connective(f, negated, true);
            case FormulaKind::disjunction: return connective(f, negated, false);
            case FormulaKind::implication:
                return implication(f.operands[0], f.operands[1], negated);
            case FormulaKind::equivalence:
                return equivalence(f.operands[0], f.operands[1], negated);
            case FormulaKind::weak_until: return weak_until(f.operands[0], f.operands[1], negated);
            // `X f` is F[1,1] f; `!X f` is G[1,1] !f. The model gives next and previous the
            // interval [1, 1].
            case FormulaKind::next:
            case FormulaKind::eventually: return temporal(f, negated, NodeKind::eventually);
            case FormulaKind::always: return temporal(f, negated, NodeKind::eventually, true);
            case FormulaKind::until: return temporal(f, negated, NodeKind::until);
            case FormulaKind::release: return temporal(f, negated, NodeKind::until, true);
            case FormulaKind::previous:
            case FormulaKind::once: return temporal(f, negated, NodeKind::once);
            case FormulaKind::historically: return temporal(f, negated, NodeKind::once, true);
            case FormulaKind::since: return temporal(f, negated, NodeKind::since);
            case FormulaKind::rise: return edge(f.operands[0], false, negated);
            case FormulaKind::fall: return edge(f.operands[0], true, negated);
            case FormulaKind::held: return held(f, negated);
            case FormulaKind::count: return count(f, negated);
        }
        return literal(NodeKind::constant, negated);
    }
};

}  // namespace

NormalForm normal_form(const check::Model& model) {
    NormalForm result;
    Builder builder(model);
    for (const check::Monitor& monitor : model.monitors)
        result.roots.push_back(builder.build(monitor.formula, false));
    result.nodes = builder.take();
    return result;
}

std::uint64_t horizon(const check::Model& model, Index formula) {
    std::vector<std::uint64_t> depth(formula + 1, 0);  // operands have smaller indices
    for (Index n = 0; n <= formula; ++n) {
        const Formula& f = model.formulas[n];
        for (const Index operand : f.operands) depth[n] = std::max(depth[n], depth[operand]);
        switch (f.kind) {
            case FormulaKind::next:
            case FormulaKind::eventually:
            case FormulaKind::always:
            case FormulaKind::until:
            case FormulaKind::weak_until:
            case FormulaKind::release: depth[n] += f.high; break;
            default: break;
        }
    }
    return depth[formula];
}

}  // namespace etlc::reference
