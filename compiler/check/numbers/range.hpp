// Intervals of float32, and arithmetic on them, rounded outward.
// Takes: the ranges of an operation's operands. Gives: a range that holds every result that the
// operation can have on them in float32, whether each operation is rounded or two are fused. Keeps
// true: low <= high, neither is a NaN; an operand outside a function's domain (sqrt of a negative
// number) gives no result, so only the defined part counts.
#pragma once

#include <limits>
#include <vector>

namespace etlc::check {

/// Closed interval of float32 values, rounded outward from the decimal text.
struct Range {
    float low = -std::numeric_limits<float>::infinity();
    float high = std::numeric_limits<float>::infinity();

    bool contains(float x) const { return low <= x && x <= high; }
};

inline constexpr Range kEverything{};

Range negate(const Range& a);
Range add(const Range& a, const Range& b);
Range subtract(const Range& a, const Range& b);
Range multiply(const Range& a, const Range& b);
/// Everything where the divisor can be zero.
Range divide(const Range& a, const Range& b);
Range abs(const Range& a);
/// Everything where no element of `a` has a square root.
Range sqrt(const Range& a);
Range min(const std::vector<Range>& ranges);
Range max(const std::vector<Range>& ranges);

}  // namespace etlc::check
