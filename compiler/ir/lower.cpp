#include "ir/lower.hpp"

#include <array>
#include <utility>

namespace etlc::ir {

namespace {

using Kind = check::Formula::Kind;

/// Lowers one model into one graph. `negated` is the number of negations above, modulo two.
class Lowering {
public:
    Lowering(const check::Model& model, Graph& graph) : model_(model), graph_(graph) {
        for (auto& memo : memo_) memo.assign(model.formulas.size(), check::kNone);
    }

    NodeId lower(Index formula, bool negated) {
        NodeId& known = memo_[negated ? 1 : 0][formula];
        if (known == check::kNone) {
            const NodeId node = build(model_.formulas[formula], negated);
            memo_[negated ? 1 : 0][formula] = node;
            return node;
        }
        return known;
    }

    std::array<std::vector<NodeId>, 2> take_nodes() { return std::move(memo_); }

private:
    static Op turn(Op op, bool negated) { return negated ? info(op).dual : op; }

    NodeId build(const check::Formula& f, bool negated) {
        switch (f.kind) {
            case Kind::constant_true: return graph_.constant(!negated);
            case Kind::constant_false: return graph_.constant(negated);
            case Kind::predicate: return graph_.literal(Op::predicate, f.index, negated, f.span);
            case Kind::boolean_input: return graph_.literal(Op::flag, f.index, negated, f.span);
            case Kind::negation: return lower(f.operands[0], !negated);
            case Kind::conjunction: return combine(f, Op::conjunction, negated);
            case Kind::disjunction: return combine(f, Op::disjunction, negated);
            case Kind::implication:
                return implication(f.operands[0], f.operands[1], negated, f.span);
            case Kind::equivalence: {
                const NodeId there = implication(f.operands[0], f.operands[1], negated, f.span);
                const NodeId back = implication(f.operands[1], f.operands[0], negated, f.span);
                return graph_.combine(turn(Op::conjunction, negated), {there, back}, f.span);
            }
            case Kind::next:
            case Kind::eventually: return unary(f, Op::eventually, negated);
            case Kind::always: return unary(f, Op::always, negated);
            case Kind::previous:
            case Kind::once: return unary(f, Op::once, negated);
            case Kind::historically: return unary(f, Op::historically, negated);
            case Kind::until: return binary(f, Op::until, negated);
            case Kind::release: return binary(f, Op::release, negated);
            case Kind::since: return binary(f, Op::since, negated);
            case Kind::weak_until: return weak_until(f, negated);
            case Kind::rise: return edge(f, false, negated);
            case Kind::fall: return edge(f, true, negated);
            case Kind::held: return held(f, negated);
            case Kind::count: return count(f, negated);
        }
        return check::kNone;
    }

    NodeId combine(const check::Formula& f, Op op, bool negated) {
        std::vector<NodeId> operands;
        for (Index operand : f.operands) operands.push_back(lower(operand, negated));
        return graph_.combine(turn(op, negated), std::move(operands), f.span);
    }

    /// Lowers f -> g as !f || g.
    NodeId implication(Index left, Index right, bool negated, Span span) {
        return graph_.combine(turn(Op::disjunction, negated),
                              {lower(left, !negated), lower(right, negated)}, span);
    }

    NodeId unary(const check::Formula& f, Op op, bool negated) {
        return graph_.unary(turn(op, negated), {f.low, f.high}, lower(f.operands[0], negated),
                            f.span);
    }

    NodeId binary(const check::Formula& f, Op op, bool negated) {
        const NodeId left = lower(f.operands[0], negated);
        const NodeId right = lower(f.operands[1], negated);
        return graph_.binary(turn(op, negated), {f.low, f.high}, left, right, f.span);
    }

    /// Lowers f W g as g R (f || g).
    NodeId weak_until(const check::Formula& f, bool negated) {
        const NodeId left = lower(f.operands[0], negated);
        const NodeId right = lower(f.operands[1], negated);
        const NodeId either = graph_.combine(turn(Op::disjunction, negated), {left, right}, f.span);
        return graph_.binary(turn(Op::release, negated), {}, right, either, f.span);
    }

    /// Lowers rise f as f && Y !f, fall f as !f && Y f.
    NodeId edge(const check::Formula& f, bool falls, bool negated) {
        const NodeId now = lower(f.operands[0], falls != negated);
        const NodeId before = lower(f.operands[0], falls == negated);
        const NodeId previous = graph_.unary(turn(Op::once, negated), {1, 1}, before, f.span);
        return graph_.combine(turn(Op::conjunction, negated), {now, previous}, f.span);
    }

    /// Lowers held[n] f as H[0,n] f && O[n,n] true.
    NodeId held(const check::Formula& f, bool negated) {
        const NodeId all = unary(f, Op::historically, negated);
        const NodeId old = graph_.unary(turn(Op::once, negated), {f.high, f.high},
                                        graph_.constant(!negated), f.span);
        return graph_.combine(turn(Op::conjunction, negated), {all, old}, f.span);
    }

    /// Lowers count(f, n) >= k as rise f at k or more of the last n positions, and a fraction as f.
    NodeId count(const check::Formula& f, bool negated) {
        const NodeId operand =
            f.each_step ? lower(f.operands[0], negated) : edge(f, false, negated);
        const Counted counted{lower(f.operands[0], false), f.each_step};
        return graph_.count(turn(Op::at_least, negated), f.index, f.high, operand, counted, f.span);
    }

    const check::Model& model_;
    Graph& graph_;
    std::array<std::vector<NodeId>, 2> memo_;
};

}  // namespace

Program lower(const check::Model& model) {
    Program program{Graph(model), {}, {}, {}, {}};
    Lowering lowering(model, program.graph);
    for (const check::Monitor& monitor : model.monitors)
        program.monitors.push_back(lowering.lower(monitor.formula, false));
    for (const check::Let& let : model.lets)
        program.lets.push_back(let.telemetry ? lowering.lower(let.formula, false) : check::kNone);
    program.formulas = lowering.take_nodes();
    return program;
}

}  // namespace etlc::ir
