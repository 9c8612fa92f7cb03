// rho(f, k, i) and its bounds for one prefix 0..i, clause by clause as docs/language.md has them.
// Takes: the negation normal form, the literals of steps 0..i, and each literal's range. Gives:
// four numbers per node and position. Keeps true: lower <= rho <= rho_high <= upper; every clause
// is quoted where it is computed.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "reference/normal_form.hpp"

namespace etlc::reference {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// What is said about a formula at a position of a prefix.
struct Value {
    double lower = 0;     ///< no longer prefix, whatever its samples, has a smaller rho here
    double rho = 0;       ///< pessimistic: unknown literals at the low end of their range
    double rho_high = 0;  ///< optimistic: unknown literals at the high end
    double upper = 0;     ///< no longer prefix has a larger rho_high here
};

/// Lowest and highest value of a formula at a position after i that some longer prefix has.
struct Unseen {
    double lowest = 0;
    double highest = 0;
};
inline Unseen negate(const Unseen& range) {
    return {-range.highest, -range.lowest};
}

/// The literals: per node of the normal form that is an atom, its value at each step and its range.
struct Literals {
    std::vector<std::vector<Value>> values;  ///< [node][step]; empty for other nodes
    std::vector<Unseen> ranges;              ///< [node]
};

class Prefix {
public:
    /// The prefix 0..end.
    Prefix(const NormalForm& form, const Literals& literals, std::uint64_t end);

    /// The node's value at `position` <= end.
    Value at(Index node, std::uint64_t position);
    Unseen unseen(Index node);

private:
    const NormalForm& form_;
    const Literals& literals_;
    std::uint64_t end_;
    std::vector<std::vector<std::optional<Value>>> values_;  // [node][position]
    std::vector<std::optional<Unseen>> unseen_;              // [node]

    Value evaluate(const Node& node, Index index, std::uint64_t k);
    // Of a node, or of the one whose dual it is, over operands that are negated then.
    Value greatest(const Node& node, std::uint64_t k);
    Value future(const Node& node, std::uint64_t k);
    Value past(const Node& node, std::uint64_t k);
    Unseen find_unseen(const Node& node, Index index);
    Value operand(const Node& node, std::size_t n, std::uint64_t position);
    Unseen unseen_operand(const Node& node, std::size_t n);
};

}  // namespace etlc::reference
