// SPDX-License-Identifier: MIT
// The comparison of a predicate: from a distance or expression to robustness. Takes: delta (a
// distance or an expression), NaN if unknown; epsilon, or two thresholds; the value for that case:
// the range of the robustness, or the one that the spec declares. Gives: epsilon - delta or delta -
// epsilon as a value, or that value. Keeps true: one float32 subtraction for each threshold; a NaN
// is detected by its bits and never becomes a verdict.
#pragma once

#include "etlmon/bits.hpp"
#include "etlmon/scalars.hpp"
#include "etlmon/temporal/value.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

namespace detail {
/// Returns whether the compiler knows that x is zero, so that nothing is subtracted. Thresholds of
/// zero are common for inputs that are robustness themselves.
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

/// Returns the robustness of delta <= epsilon and delta < epsilon (Definition "Embedding
/// Predicate").
ETLMON_INLINE Value at_most(const float& delta, const float& epsilon, Value range) noexcept {
  if (is_nan(delta)) return range;
  const Key robustness =
      detail::surely_zero(epsilon) ? -key_of(delta) : key_of(detail::rounded(epsilon - delta));
  return {robustness, robustness};
}

/// Returns the robustness of delta >= epsilon and delta > epsilon.
ETLMON_INLINE Value at_least(const float& delta, const float& epsilon, Value range) noexcept {
  if (is_nan(delta)) return range;
  const Key robustness =
      detail::surely_zero(epsilon) ? key_of(delta) : key_of(detail::rounded(delta - epsilon));
  return {robustness, robustness};
}

namespace detail {
/// Returns the key of threshold - x. Nothing is beyond an infinite threshold: it stays infinite
/// whatever x is.
ETLMON_INLINE Key up_to(const float& threshold, const float& x) noexcept {
  return is_finite(threshold) ? key_of(rounded(threshold - x)) : key_of(threshold);
}
}  // namespace detail

// Of two thresholds: what is within `inner` is true, what is beyond `outer` false. What is between
// them is neither: the range of its robustness contains 0.
ETLMON_INLINE Value at_most(const float& delta, const float& inner, const float& outer,
                            Value range) noexcept {
  if (is_nan(delta)) return range;
  return {detail::up_to(inner, delta), detail::up_to(outer, delta)};
}
ETLMON_INLINE Value at_least(const float& delta, const float& inner, const float& outer,
                             Value range) noexcept {
  if (is_nan(delta)) return range;
  return {-detail::up_to(inner, delta), -detail::up_to(outer, delta)};
}

/// Returns the value of a bool input: +inf for true, -inf for false, `missing` (by default the
/// whole range) if missing.
ETLMON_INLINE Value value_of(Flag flag, Value missing = {kBottom, kTop}) noexcept {
  if (!flag.present()) return missing;
  return flag.value() ? kTrue : kFalse;
}

/// Returns whether the robustness is a range: of a missing sample, or between two thresholds.
constexpr bool unknown(Value value) noexcept { return value.low != value.high; }

}  // namespace ETLMON_BUILD
}  // namespace etlmon
