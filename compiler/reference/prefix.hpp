// Evaluates rho(f, k, i) and its bounds on one prefix 0..i, clause by clause as docs/semantics.md
// defines them; each clause is quoted where it is computed. lower <= rho <= rho_high <= upper.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "reference/normal_form.hpp"

namespace etlc::reference {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The value of a formula at a position of a prefix. Number: double, or a type with constants, min,
/// max and negation, by which `etlc prove` expands a formula over all samples.
template <class Number>
struct ValueOf {
    Number lower{};     ///< lower bound of rho over all longer prefixes
    Number rho{};       ///< pessimistic: unknown literals at the low end of their range
    Number rho_high{};  ///< optimistic: unknown literals at the high end
    Number upper{};     ///< upper bound of rho_high over all longer prefixes
};
using Value = ValueOf<double>;

/// The lowest and highest value of a formula at a position after i, over all longer prefixes.
template <class Number>
struct UnseenOf {
    Number lowest{};
    Number highest{};
};
using Unseen = UnseenOf<double>;
template <class Number>
UnseenOf<Number> negate(const UnseenOf<Number>& range) {
    return {-range.highest, -range.lowest};
}

/// The literals: per atom of the normal form, its value at each step and its range.
template <class Number>
struct LiteralsOf {
    std::vector<std::vector<ValueOf<Number>>> values;  ///< [node][step]; empty for other nodes
    std::vector<UnseenOf<Number>> ranges;              ///< [node]
};
using Literals = LiteralsOf<double>;

template <class Number>
class PrefixOf {
public:
    using Value = ValueOf<Number>;
    using Unseen = UnseenOf<Number>;

    /// Makes the prefix 0..end.
    PrefixOf(const NormalForm& form, const LiteralsOf<Number>& literals, std::uint64_t end);

    /// Returns the node's value at `position` <= end.
    Value at(Index node, std::uint64_t position);
    Unseen unseen(Index node);

private:
    const NormalForm& form_;
    const LiteralsOf<Number>& literals_;
    std::uint64_t end_;
    std::vector<std::vector<std::optional<Value>>> values_;  // [node][position]
    std::vector<std::optional<Unseen>> unseen_;              // [node]

    Value evaluate(const Node& node, Index index, std::uint64_t k);
    // These evaluate a node, or for a dual the operator that it is the dual of, over negated
    // operands.
    Value greatest(const Node& node, std::uint64_t k);
    Value future(const Node& node, std::uint64_t k);
    Value past(const Node& node, std::uint64_t k);
    Value often(const Node& node, std::uint64_t k);
    Unseen find_unseen(const Node& node, Index index);
    Value operand(const Node& node, std::size_t n, std::uint64_t position);
    Unseen unseen_operand(const Node& node, std::size_t n);
};
using Prefix = PrefixOf<double>;

}  // namespace etlc::reference
