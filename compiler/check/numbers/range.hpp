// Interval arithmetic on float32, rounded outward. The result contains every value that the
// operation can have in float32, whether each operation is rounded or two are fused. low <= high,
// and neither is NaN. Operands outside a function's domain (sqrt of negative numbers) do not count.
#pragma once

#include <cstdint>
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

// Limits of interval bounds, in steps.

inline constexpr std::uint32_t kUnbounded = std::numeric_limits<std::uint32_t>::max();
inline constexpr std::uint32_t kMaxBound = (1U << 31U) - 2U;  ///< in steps
/// Limit of numbers that earlier steps have a part in, in steps, each of which takes memory.
inline constexpr std::uint32_t kMaxPast = 1U << 24U;
/// The greatest number that a count is compared with: a window keeps as many values a step.
inline constexpr std::uint32_t kMaxCount = 100;

}  // namespace etlc::check
