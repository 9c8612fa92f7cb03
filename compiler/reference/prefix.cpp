#include "reference/prefix.hpp"

#include <algorithm>

namespace etlc::reference {
namespace {

constexpr Value kTrue{kInfinity, kInfinity, kInfinity, kInfinity};
constexpr Value kFalse{-kInfinity, -kInfinity, -kInfinity, -kInfinity};

Value min(const Value& a, const Value& b) {
    return {std::min(a.lower, b.lower), std::min(a.rho, b.rho), std::min(a.rho_high, b.rho_high),
            std::min(a.upper, b.upper)};
}

Value max(const Value& a, const Value& b) {
    return {std::max(a.lower, b.lower), std::max(a.rho, b.rho), std::max(a.rho_high, b.rho_high),
            std::max(a.upper, b.upper)};
}

/// The positions j of a future operator at k on the prefix 0..end: j in [k+a, min(k+b, i)].
struct Future {
    std::uint64_t first;
    std::uint64_t last;
    bool reaches_past_end;

    Future(const Node& node, std::uint64_t k, std::uint64_t end) : first(k + node.low), last(end) {
        const bool unbounded = node.high == check::kUnbounded;
        if (!unbounded) last = std::min(k + node.high, end);
        reaches_past_end = unbounded || k + node.high > end;
    }
};

/// The positions j of a past operator at k: j in [max(0, k-b), k-a]; none where a > k.
struct Past {
    bool empty;
    std::uint64_t first;
    std::uint64_t last;

    Past(const Node& node, std::uint64_t k)
        : empty(node.low > k), first(0), last(empty ? 0 : k - node.low) {
        if (node.high != check::kUnbounded && node.high < k) first = k - node.high;
    }
};

}  // namespace

Prefix::Prefix(const NormalForm& form, const Literals& literals, std::uint64_t end)
    : form_(form),
      literals_(literals),
      end_(end),
      values_(form.nodes.size()),
      unseen_(form.nodes.size()) {}

Value Prefix::at(Index node, std::uint64_t position) {
    if (values_[node].empty()) values_[node].resize(end_ + 1);
    if (!values_[node][position])
        values_[node][position] = evaluate(form_.nodes[node], node, position);
    return *values_[node][position];
}

Unseen Prefix::unseen(Index node) {
    if (!unseen_[node]) unseen_[node] = find_unseen(form_.nodes[node], node);
    return *unseen_[node];
}

Value Prefix::evaluate(const Node& node, Index index, std::uint64_t k) {
    switch (node.kind) {
        // "`true`, `false`: +inf, -inf"
        case Node::Kind::constant: return node.negated ? kFalse : kTrue;
        case Node::Kind::predicate:
        case Node::Kind::boolean: return literals_.values[index][k];
        // "`f && g`, `f || g`: min, max"
        case Node::Kind::all: {
            Value result = kTrue;
            for (const Index operand : node.operands) result = min(result, at(operand, k));
            return result;
        }
        case Node::Kind::any: {
            Value result = kFalse;
            for (const Index operand : node.operands) result = max(result, at(operand, k));
            return result;
        }
        case Node::Kind::eventually: return eventually(node, k);
        case Node::Kind::always: return always(node, k);
        case Node::Kind::until: return until(node, k);
        case Node::Kind::release: return release(node, k);
        case Node::Kind::once: return once(node, k);
        case Node::Kind::historically: return historically(node, k);
        case Node::Kind::since: return since(node, k);
        case Node::Kind::trigger: return trigger(node, k);
    }
    return kFalse;
}

/// "`F[a,b] f`: max of rho(f, j, i) over j in [k+a, min(k+b, i)]; no such j: -inf"
/// "F: lower = max of the known operands' lowers, upper = max of their uppers and, where the window
/// reaches past i, of the operand's highest unseen value"
Value Prefix::eventually(const Node& node, std::uint64_t k) {
    const Future window(node, k, end_);
    Value result = kFalse;
    for (std::uint64_t j = window.first; j <= window.last; ++j)
        result = max(result, at(node.operands[0], j));
    if (window.reaches_past_end)
        result.upper = std::max(result.upper, unseen(node.operands[0]).highest);
    return result;
}

/// "`G[a,b] f`: min over the same j; no such j: +inf"
/// "G: the dual": where the window reaches past i, lower also takes the operand's lowest unseen
/// value.
Value Prefix::always(const Node& node, std::uint64_t k) {
    const Future window(node, k, end_);
    Value result = kTrue;
    for (std::uint64_t j = window.first; j <= window.last; ++j)
        result = min(result, at(node.operands[0], j));
    if (window.reaches_past_end)
        result.lower = std::min(result.lower, unseen(node.operands[0]).lowest);
    return result;
}

/// "`f U[a,b] g`: max over the same j of min(rho(g, j, i), min of rho(f, m, i) over m in [k, j));
/// no such j: -inf" "U: both from the known j as in the table, and where the window reaches past i,
/// upper also takes min(min of f's uppers over [k, i], g's highest unseen value)"
Value Prefix::until(const Node& node, std::uint64_t k) {
    const Index f = node.operands[0];
    const Index g = node.operands[1];
    const Future window(node, k, end_);
    Value result = kFalse;
    for (std::uint64_t j = window.first; j <= window.last; ++j) {
        Value witness = at(g, j);
        for (std::uint64_t m = k; m < j; ++m) witness = min(witness, at(f, m));
        result = max(result, witness);
    }
    if (window.reaches_past_end) {
        double later = unseen(g).highest;
        for (std::uint64_t m = k; m <= end_; ++m) later = std::min(later, at(f, m).upper);
        result.upper = std::max(result.upper, later);
    }
    return result;
}

/// "`f R[a,b] g`: the dual: -rho(!f U[a,b] !g)": min over the same j of max(g at j, max of f over m
/// in [k, j)). "R: the dual": past i, lower also takes max(max of f's lowers over [k, i], g's
/// lowest unseen value).
Value Prefix::release(const Node& node, std::uint64_t k) {
    const Index f = node.operands[0];
    const Index g = node.operands[1];
    const Future window(node, k, end_);
    Value result = kTrue;
    for (std::uint64_t j = window.first; j <= window.last; ++j) {
        Value witness = at(g, j);
        for (std::uint64_t m = k; m < j; ++m) witness = max(witness, at(f, m));
        result = min(result, witness);
    }
    if (window.reaches_past_end) {
        double later = unseen(g).lowest;
        for (std::uint64_t m = k; m <= end_; ++m) later = std::max(later, at(f, m).lower);
        result.lower = std::min(result.lower, later);
    }
    return result;
}

/// "`O[a,b] f`: max of rho(f, j, i) over j in [max(0, k-b), k-a]; no such j: -inf"
/// "past operators: as in the table, on the known part"
Value Prefix::once(const Node& node, std::uint64_t k) {
    const Past window(node, k);
    Value result = kFalse;
    if (window.empty) return result;
    for (std::uint64_t j = window.first; j <= window.last; ++j)
        result = max(result, at(node.operands[0], j));
    return result;
}

/// "`H[a,b] f`: min of rho(f, j, i) over the same j; no such j: +inf"
Value Prefix::historically(const Node& node, std::uint64_t k) {
    const Past window(node, k);
    Value result = kTrue;
    if (window.empty) return result;
    for (std::uint64_t j = window.first; j <= window.last; ++j)
        result = min(result, at(node.operands[0], j));
    return result;
}

/// "`f S[a,b] g`: max over the same j of min(rho(g, j, i), min of rho(f, m, i) over m in (j, k])"
Value Prefix::since(const Node& node, std::uint64_t k) {
    const Past window(node, k);
    Value result = kFalse;
    if (window.empty) return result;
    for (std::uint64_t j = window.first; j <= window.last; ++j) {
        Value witness = at(node.operands[1], j);
        for (std::uint64_t m = j + 1; m <= k; ++m) witness = min(witness, at(node.operands[0], m));
        result = max(result, witness);
    }
    return result;
}

/// The dual of since: min over the same j of max(g at j, max of f over m in (j, k]); no such j:
/// +inf.
Value Prefix::trigger(const Node& node, std::uint64_t k) {
    const Past window(node, k);
    Value result = kTrue;
    if (window.empty) return result;
    for (std::uint64_t j = window.first; j <= window.last; ++j) {
        Value witness = at(node.operands[1], j);
        for (std::uint64_t m = j + 1; m <= k; ++m) witness = max(witness, at(node.operands[0], m));
        result = min(result, witness);
    }
    return result;
}

// ---- lowest and highest unseen values -----------------------------------------------------------

double Prefix::greatest_known_lower(Index node) {
    double result = -kInfinity;
    for (std::uint64_t j = 0; j <= end_; ++j) result = std::max(result, at(node, j).lower);
    return result;
}

double Prefix::greatest_known_upper(Index node) {
    double result = -kInfinity;
    for (std::uint64_t j = 0; j <= end_; ++j) result = std::max(result, at(node, j).upper);
    return result;
}

double Prefix::least_known_lower(Index node) {
    double result = kInfinity;
    for (std::uint64_t j = 0; j <= end_; ++j) result = std::min(result, at(node, j).lower);
    return result;
}

double Prefix::least_known_upper(Index node) {
    double result = kInfinity;
    for (std::uint64_t j = 0; j <= end_; ++j) result = std::min(result, at(node, j).upper);
    return result;
}

/// "The lowest and highest unseen value of a formula, at a position after i that some longer prefix
/// has".
///
/// For past operators "what is known of their operand" is read as its values at every position
/// 0..i, also where a bounded window at an unseen position could no longer reach all of them:
/// sound, and it needs a running extreme only. Their windows at unseen positions reach back over
/// the known part, so what is known widens the range of O, S and H, and it narrows the other end of
/// an O or H that never forgets it (b = inf) and sees every position (a = 0).
Unseen Prefix::find_unseen(const Node& node, Index index) {
    const auto operand = [&](std::size_t n) { return unseen(node.operands[n]); };
    const bool from_now = node.low == 0;
    const bool unbounded = node.high == check::kUnbounded;
    switch (node.kind) {
        case Node::Kind::constant:
            return node.negated ? Unseen{-kInfinity, -kInfinity} : Unseen{kInfinity, kInfinity};
        // "for a predicate its range"; a bool's is [-inf, +inf]
        case Node::Kind::predicate:
        case Node::Kind::boolean: return literals_.ranges[index];
        // "min and max for && and ||"
        case Node::Kind::all: {
            Unseen result{kInfinity, kInfinity};
            for (std::size_t n = 0; n < node.operands.size(); ++n) {
                result.lowest = std::min(result.lowest, operand(n).lowest);
                result.highest = std::min(result.highest, operand(n).highest);
            }
            return result;
        }
        case Node::Kind::any: {
            Unseen result{-kInfinity, -kInfinity};
            for (std::size_t n = 0; n < node.operands.size(); ++n) {
                result.lowest = std::max(result.lowest, operand(n).lowest);
                result.highest = std::max(result.highest, operand(n).highest);
            }
            return result;
        }
        // "F, O: lowest that of the operand if a = 0, else -inf, highest the operand's"
        case Node::Kind::eventually:
            return {from_now ? operand(0).lowest : -kInfinity, operand(0).highest};
        // "G, H: highest the operand's if a = 0, else +inf, lowest the operand's"
        case Node::Kind::always:
            return {operand(0).lowest, from_now ? operand(0).highest : kInfinity};
        // "U, S: lowest g's if a = 0, else -inf, highest g's"
        case Node::Kind::until:
            return {from_now ? operand(1).lowest : -kInfinity, operand(1).highest};
        // "R: highest g's if a = 0, else +inf, lowest g's"
        case Node::Kind::release:
            return {operand(1).lowest, from_now ? operand(1).highest : kInfinity};
        // "O and S have a highest of at least [...] what is known of their (last) operand; and an
        // unbounded O with a = 0 has a lowest of at least the greatest known lower"
        case Node::Kind::once: {
            Unseen result{from_now ? operand(0).lowest : -kInfinity, operand(0).highest};
            result.highest = std::max(result.highest, greatest_known_upper(node.operands[0]));
            if (from_now && unbounded)
                result.lowest = std::max(result.lowest, greatest_known_lower(node.operands[0]));
            return result;
        }
        // "H a lowest of at most [what is known]; an unbounded H with a = 0 a highest of at most
        // the least known upper"
        case Node::Kind::historically: {
            Unseen result{operand(0).lowest, from_now ? operand(0).highest : kInfinity};
            result.lowest = std::min(result.lowest, least_known_lower(node.operands[0]));
            if (from_now && unbounded)
                result.highest = std::min(result.highest, least_known_upper(node.operands[0]));
            return result;
        }
        case Node::Kind::since:
            return {from_now ? operand(1).lowest : -kInfinity,
                    std::max(operand(1).highest, greatest_known_upper(node.operands[1]))};
        // The dual of S, made by negation: as R, and H's lowest.
        case Node::Kind::trigger:
            return {std::min(operand(1).lowest, least_known_lower(node.operands[1])),
                    from_now ? operand(1).highest : kInfinity};
    }
    return {-kInfinity, kInfinity};
}

}  // namespace etlc::reference
