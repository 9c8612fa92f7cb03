// Interval arithmetic on float32, rounded outward. The result contains every value that the
// operation can have in float32, whether each operation is rounded or two are fused. low <= high,
// and neither is NaN. Operands outside a function's domain (sqrt of negative numbers) do not count.
#pragma once

#include <limits>
#include <vector>

namespace etlc::check {

/// A closed interval of float32 values.
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
/// Returns everything if the divisor can be zero.
Range divide(const Range& a, const Range& b);
Range abs(const Range& a);
/// Returns everything if no element of `a` has a square root.
Range sqrt(const Range& a);
Range min(const std::vector<Range>& ranges);
Range max(const std::vector<Range>& ranges);

}  // namespace etlc::check
