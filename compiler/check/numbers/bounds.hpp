// Limits of interval bounds, in steps.
#pragma once

#include <cstdint>
#include <limits>

namespace etlc::check {

inline constexpr std::uint32_t kUnbounded = std::numeric_limits<std::uint32_t>::max();
inline constexpr std::uint32_t kMaxBound = (1U << 31U) - 2U;  ///< in steps
/// Limit of numbers that earlier steps have a part in, in steps, each of which takes memory.
inline constexpr std::uint32_t kMaxPast = 1U << 24U;
/// The greatest number that a count is compared with: a window keeps as many values a step.
inline constexpr std::uint32_t kMaxCount = 100;

}  // namespace etlc::check
