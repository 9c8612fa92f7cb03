// The clauses of docs/semantics.md, for any type of number: included where they are instantiated.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "reference/prefix.hpp"

namespace etlc::reference {
namespace clauses {

using std::max;
using std::min;

template <class Number>
ValueOf<Number> negate(const ValueOf<Number>& v) {
    return {-v.upper, -v.rho_high, -v.rho, -v.lower};
}

template <class Number>
ValueOf<Number> all_of(double x) {
    const Number number = x;
    return {number, number, number, number};
}

template <class Number>
ValueOf<Number> min(const ValueOf<Number>& a, const ValueOf<Number>& b) {
    return {min(a.lower, b.lower), min(a.rho, b.rho), min(a.rho_high, b.rho_high),
            min(a.upper, b.upper)};
}

template <class Number>
ValueOf<Number> max(const ValueOf<Number>& a, const ValueOf<Number>& b) {
    return {max(a.lower, b.lower), max(a.rho, b.rho), max(a.rho_high, b.rho_high),
            max(a.upper, b.upper)};
}

inline bool looks_ahead(const Node& node) {
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

}  // namespace clauses

template <class Number>
PrefixOf<Number>::PrefixOf(const NormalForm& form, const LiteralsOf<Number>& literals,
                           std::uint64_t end)
    : form_(form),
      literals_(literals),
      end_(end),
      values_(form.nodes.size()),
      unseen_(form.nodes.size()) {}

template <class Number>
ValueOf<Number> PrefixOf<Number>::at(Index node, std::uint64_t position) {
    if (values_[node].empty()) values_[node].resize(end_ + 1);
    if (!values_[node][position])
        values_[node][position] = evaluate(form_.nodes[node], node, position);
    return *values_[node][position];
}

template <class Number>
UnseenOf<Number> PrefixOf<Number>::unseen(Index node) {
    if (!unseen_[node]) unseen_[node] = find_unseen(form_.nodes[node], node);
    return *unseen_[node];
}

/// Duals are made by negation: "`f R[a,b] g`: the dual: -rho(!f U[a,b] !g)", and likewise min from
/// max, G from F, and H from O.
template <class Number>
ValueOf<Number> PrefixOf<Number>::operand(const Node& node, std::size_t n, std::uint64_t position) {
    const Value value = at(node.operands[n], position);
    return node.negated ? clauses::negate(value) : value;
}

template <class Number>
UnseenOf<Number> PrefixOf<Number>::unseen_operand(const Node& node, std::size_t n) {
    const Unseen range = unseen(node.operands[n]);
    return node.negated ? negate(range) : range;
}

template <class Number>
ValueOf<Number> PrefixOf<Number>::evaluate(const Node& node, Index index, std::uint64_t k) {
    // "`true`, `false`: +inf, -inf"
    if (node.kind == Node::Kind::constant)
        return clauses::all_of<Number>(node.negated ? -kInfinity : kInfinity);
    if (node.is_atom()) return literals_.values[index][k];
    const Value result = node.kind == Node::Kind::any        ? greatest(node, k)
                         : clauses::looks_ahead(node)        ? future(node, k)
                         : node.kind == Node::Kind::at_least ? often(node, k)
                                                             : past(node, k);
    return node.negated ? clauses::negate(result) : result;
}

/// "`f && g`, `f || g`: min, max"
template <class Number>
ValueOf<Number> PrefixOf<Number>::greatest(const Node& node, std::uint64_t k) {
    Value result = clauses::all_of<Number>(-kInfinity);
    for (std::size_t n = 0; n < node.operands.size(); ++n)
        result = clauses::max(result, operand(node, n, k));
    return result;
}

/// "`F[a,b] f`: max of rho(f, j, i) over j in [k+a, min(k+b, i)]; no such j: -inf"
/// "F: lower = max of the known operands' lowers, upper = max of their uppers and, where the window
/// reaches past i, of the operand's highest unseen value"
/// "`f U[a,b] g`: max over the same j of min(rho(g, j, i), min of rho(f, m, i) over m in [k, j));
/// no such j: -inf" "U: both from the known j as in the table, and where the window reaches past i,
/// upper also takes min(min of f's uppers over [k, i], g's highest unseen value)"
template <class Number>
ValueOf<Number> PrefixOf<Number>::future(const Node& node, std::uint64_t k) {
    const std::size_t g = node.operands.size() - 1;
    const clauses::Future window(node, k, end_);
    Value result = clauses::all_of<Number>(-kInfinity);
    Value held = clauses::all_of<Number>(kInfinity);  // min of f over [k, j)
    for (std::uint64_t j = g > 0 ? k : window.first; j <= window.last; ++j) {
        if (j >= window.first)
            result = clauses::max(result, clauses::min(operand(node, g, j), held));
        if (g > 0) held = clauses::min(held, operand(node, 0, j));
    }
    if (!window.reaches_past_end) return result;
    using clauses::max, clauses::min;
    result.upper = max(result.upper, min(unseen_operand(node, g).highest, held.upper));
    return result;
}

/// "`O[a,b] f`: max of rho(f, j, i) over j in [max(0, k-b), k-a]; no such j: -inf"
/// "`f S[a,b] g`: max over the same j of min(rho(g, j, i), min of rho(f, m, i) over m in (j, k])"
/// "past operators: as in the table, on the known part"
template <class Number>
ValueOf<Number> PrefixOf<Number>::past(const Node& node, std::uint64_t k) {
    const std::size_t g = node.operands.size() - 1;
    const clauses::Past window(node, k);
    Value result = clauses::all_of<Number>(-kInfinity);
    for (std::uint64_t j = window.first; !window.empty && j <= window.last; ++j) {
        Value held = clauses::all_of<Number>(kInfinity);  // min of f over (j, k]
        for (std::uint64_t m = j + 1; g > 0 && m <= k; ++m)
            held = clauses::min(held, operand(node, 0, m));
        result = clauses::max(result, clauses::min(operand(node, g, j), held));
    }
    return result;
}

/// "`count(f, D) >= n`: the n-th greatest of rho(rise f, j, i) over the last positions; fewer than
/// n positions: -inf" "`fraction(f, D) >= s`: of rho(f, j, i), with n the least number of steps
/// that is s or more of those of D"
template <class Number>
ValueOf<Number> PrefixOf<Number>::often(const Node& node, std::uint64_t k) {
    const clauses::Past window(node, k);
    // nth[m]: the m-th greatest so far, from 1. With one more value v it is the greater of itself
    // and the lesser of v and the one before it.
    std::vector<Value> nth(node.index + 1, clauses::all_of<Number>(-kInfinity));
    nth[0] = clauses::all_of<Number>(kInfinity);
    for (std::uint64_t j = window.first; j <= window.last; ++j)
        for (std::uint32_t m = node.index; m > 0; --m)
            nth[m] = clauses::max(nth[m], clauses::min(nth[m - 1], operand(node, 0, j)));
    return nth[node.index];
}

/// "The lowest and highest unseen value of a formula, at a position after i that some longer prefix
/// has".
///
/// For past operators "what is known of their operand" is read as its values at every position
/// 0..i, also where a bounded window at an unseen position could no longer reach all of them:
/// sound, and it needs a running extreme only. Their windows at unseen positions reach back over
/// the known part, so what is known widens the range of O, S and H, and it narrows the other end of
/// an O or H that never forgets it (b = inf) and sees every position (a = 0).
template <class Number>
UnseenOf<Number> PrefixOf<Number>::find_unseen(const Node& node, Index index) {
    if (node.kind == Node::Kind::constant) {
        const Number x = node.negated ? -kInfinity : kInfinity;
        return {x, x};
    }
    // "for a predicate its range"; a bool's is [-inf, +inf]
    if (node.is_atom()) return literals_.ranges[index];
    using clauses::max;
    Unseen result{-kInfinity, -kInfinity};
    if (node.kind == Node::Kind::any) {
        // "min and max for && and ||"
        for (std::size_t n = 0; n < node.operands.size(); ++n) {
            const Unseen one = unseen_operand(node, n);
            result = {max(result.lowest, one.lowest), max(result.highest, one.highest)};
        }
        return node.negated ? negate(result) : result;
    }
    // "F, O, U, S: lowest that of the (last) operand if a = 0, else -inf, highest the operand's"
    const std::size_t last = node.operands.size() - 1;
    result = unseen_operand(node, last);
    if (node.low > 0 || node.kind == Node::Kind::at_least) result.lowest = Number(-kInfinity);
    // "O and S have a highest of at least [...] what is known of their (last) operand; and an
    // unbounded O with a = 0 has a lowest of at least the greatest known lower"
    const bool never_forgets = node.kind != Node::Kind::at_least && last == 0 && node.low == 0 &&
                               node.high == check::kUnbounded;
    for (std::uint64_t j = 0; !clauses::looks_ahead(node) && j <= end_; ++j) {
        const Value known = operand(node, last, j);
        result.highest = max(result.highest, known.upper);
        if (never_forgets) result.lowest = max(result.lowest, known.lower);
    }
    return node.negated ? negate(result) : result;
}

}  // namespace etlc::reference
