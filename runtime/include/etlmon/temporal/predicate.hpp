// SPDX-License-Identifier: MIT
// From what was measured to robustness: the comparison of a predicate.
// Takes: delta (a distance or an expression), NaN where it is unknown; epsilon; what stands for it
// then: the range of the robustness, or what the spec lets it count as. Gives: epsilon - delta or
// delta - epsilon as a value, or what stands for it. Keeps true: one float32 subtraction; a NaN is
// found by its bits and never becomes a verdict.
#pragma once

#include "etlmon/bits.hpp"
#include "etlmon/scalars.hpp"
#include "etlmon/temporal/value.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

namespace detail {
/// The compiler sees that x is zero. A threshold of zero is common where the input is a robustness
/// itself, and leaves nothing to subtract.
ETLMON_INLINE bool surely_zero(const float& x) noexcept {
#if defined(__GNUC__)
  uint32_t bits = 0;
  copy_bytes(&bits, &x, sizeof bits);
  return __builtin_constant_p(bits << 1) && bits << 1 == 0;
#else
  (void)x;
  return false;
#endif
}
}  // namespace detail

/// delta <= epsilon and delta < epsilon (Definition "Embedding Predicate").
ETLMON_INLINE Value at_most(const float& delta, const float& epsilon, Value range) noexcept {
  if (is_nan(delta)) return range;
  const Key robustness =
      detail::surely_zero(epsilon) ? -key_of(delta) : key_of(detail::rounded(epsilon - delta));
  return {robustness, robustness};
}

/// delta >= epsilon and delta > epsilon.
ETLMON_INLINE Value at_least(const float& delta, const float& epsilon, Value range) noexcept {
  if (is_nan(delta)) return range;
  const Key robustness =
      detail::surely_zero(epsilon) ? key_of(delta) : key_of(detail::rounded(delta - epsilon));
  return {robustness, robustness};
}

/// A bool input: true is +inf, false is -inf, missing is anything in between, or `missing`.
ETLMON_INLINE Value value_of(Flag flag, Value missing = {kBottom, kTop}) noexcept {
  if (!flag.present()) return missing;
  return flag.value() ? kTrue : kFalse;
}

/// Some sample behind the value was missing.
constexpr bool unknown(Value value) noexcept { return value.low != value.high; }

}  // namespace ETLMON_BUILD
}  // namespace etlmon
