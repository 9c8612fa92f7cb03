#include "reference/prefix.hpp"

#include <algorithm>
#include <functional>

namespace etlc::reference {
namespace {

Value negate(const Value& v) {
    return {-v.upper, -v.rho_high, -v.rho, -v.lower};
}

Value all_of(double x) {
    return {x, x, x, x};
}

Value min(const Value& a, const Value& b) {
    return {std::min(a.lower, b.lower), std::min(a.rho, b.rho), std::min(a.rho_high, b.rho_high),
            std::min(a.upper, b.upper)};
}

Value max(const Value& a, const Value& b) {
    return {std::max(a.lower, b.lower), std::max(a.rho, b.rho), std::max(a.rho_high, b.rho_high),
            std::max(a.upper, b.upper)};
}

bool looks_ahead(const Node& node) {
    return node.kind == Node::Kind::eventually || node.kind == Node::Kind::until;
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

/// Duals are made by negation: "`f R[a,b] g`: the dual: -rho(!f U[a,b] !g)", and likewise min from
/// max, G from F, and H from O.
Value Prefix::operand(const Node& node, std::size_t n, std::uint64_t position) {
    const Value value = at(node.operands[n], position);
    return node.negated ? negate(value) : value;
}

Unseen Prefix::unseen_operand(const Node& node, std::size_t n) {
    const Unseen range = unseen(node.operands[n]);
    return node.negated ? negate(range) : range;
}

Value Prefix::evaluate(const Node& node, Index index, std::uint64_t k) {
    // "`true`, `false`: +inf, -inf"
    if (node.kind == Node::Kind::constant) return all_of(node.negated ? -kInfinity : kInfinity);
    if (node.is_atom()) return literals_.values[index][k];
    const Value result = node.kind == Node::Kind::any        ? greatest(node, k)
                         : looks_ahead(node)                 ? future(node, k)
                         : node.kind == Node::Kind::at_least ? often(node, k)
                                                             : past(node, k);
    return node.negated ? negate(result) : result;
}

/// "`f && g`, `f || g`: min, max"
Value Prefix::greatest(const Node& node, std::uint64_t k) {
    Value result = all_of(-kInfinity);
    for (std::size_t n = 0; n < node.operands.size(); ++n)
        result = max(result, operand(node, n, k));
    return result;
}

/// "`F[a,b] f`: max of rho(f, j, i) over j in [k+a, min(k+b, i)]; no such j: -inf"
/// "F: lower = max of the known operands' lowers, upper = max of their uppers and, where the window
/// reaches past i, of the operand's highest unseen value"
/// "`f U[a,b] g`: max over the same j of min(rho(g, j, i), min of rho(f, m, i) over m in [k, j));
/// no such j: -inf" "U: both from the known j as in the table, and where the window reaches past i,
/// upper also takes min(min of f's uppers over [k, i], g's highest unseen value)"
Value Prefix::future(const Node& node, std::uint64_t k) {
    const std::size_t g = node.operands.size() - 1;
    const Future window(node, k, end_);
    Value result = all_of(-kInfinity);
    for (std::uint64_t j = window.first; j <= window.last; ++j) {
        Value witness = operand(node, g, j);
        for (std::uint64_t m = k; g > 0 && m < j; ++m) witness = min(witness, operand(node, 0, m));
        result = max(result, witness);
    }
    if (!window.reaches_past_end) return result;
    double later = unseen_operand(node, g).highest;
    for (std::uint64_t m = k; g > 0 && m <= end_; ++m)
        later = std::min(later, operand(node, 0, m).upper);
    result.upper = std::max(result.upper, later);
    return result;
}

/// "`O[a,b] f`: max of rho(f, j, i) over j in [max(0, k-b), k-a]; no such j: -inf"
/// "`f S[a,b] g`: max over the same j of min(rho(g, j, i), min of rho(f, m, i) over m in (j, k])"
/// "past operators: as in the table, on the known part"
Value Prefix::past(const Node& node, std::uint64_t k) {
    const std::size_t g = node.operands.size() - 1;
    const Past window(node, k);
    Value result = all_of(-kInfinity);
    for (std::uint64_t j = window.first; !window.empty && j <= window.last; ++j) {
        Value witness = operand(node, g, j);
        for (std::uint64_t m = j + 1; g > 0 && m <= k; ++m)
            witness = min(witness, operand(node, 0, m));
        result = max(result, witness);
    }
    return result;
}

/// "`count(f, D) >= n`: the n-th greatest of rho(rise f, j, i) over the last positions; fewer than
/// n positions: -inf"
Value Prefix::often(const Node& node, std::uint64_t k) {
    const Past window(node, k);
    std::vector<double> lowers, rhos, highs, uppers;
    for (std::uint64_t j = window.first; j <= window.last; ++j) {
        const Value value = operand(node, 0, j);
        lowers.push_back(value.lower);
        rhos.push_back(value.rho);
        highs.push_back(value.rho_high);
        uppers.push_back(value.upper);
    }
    const auto nth = [&](std::vector<double>& values) {
        if (values.size() < node.index) return -kInfinity;
        std::sort(values.begin(), values.end(), std::greater<>());
        return values[node.index - 1];
    };
    return {nth(lowers), nth(rhos), nth(highs), nth(uppers)};
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
    if (node.kind == Node::Kind::constant) {
        const double x = node.negated ? -kInfinity : kInfinity;
        return {x, x};
    }
    // "for a predicate its range"; a bool's is [-inf, +inf]
    if (node.is_atom()) return literals_.ranges[index];
    Unseen result{-kInfinity, -kInfinity};
    if (node.kind == Node::Kind::any) {
        // "min and max for && and ||"
        for (std::size_t n = 0; n < node.operands.size(); ++n) {
            const Unseen one = unseen_operand(node, n);
            result = {std::max(result.lowest, one.lowest), std::max(result.highest, one.highest)};
        }
        return node.negated ? negate(result) : result;
    }
    // "F, O, U, S: lowest that of the (last) operand if a = 0, else -inf, highest the operand's"
    const std::size_t last = node.operands.size() - 1;
    result = unseen_operand(node, last);
    if (node.low > 0 || node.kind == Node::Kind::at_least) result.lowest = -kInfinity;
    // "O and S have a highest of at least [...] what is known of their (last) operand; and an
    // unbounded O with a = 0 has a lowest of at least the greatest known lower"
    const bool never_forgets = node.kind != Node::Kind::at_least && last == 0 && node.low == 0 &&
                               node.high == check::kUnbounded;
    for (std::uint64_t j = 0; !looks_ahead(node) && j <= end_; ++j) {
        const Value known = operand(node, last, j);
        result.highest = std::max(result.highest, known.upper);
        if (never_forgets) result.lowest = std::max(result.lowest, known.lower);
    }
    return node.negated ? negate(result) : result;
}

}  // namespace etlc::reference
