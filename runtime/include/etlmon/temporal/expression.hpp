// SPDX-License-Identifier: MIT
// Arithmetic of EXPR predicates: each operation is rounded once to float32, and a NaN operand gives
// NaN. Takes: floats, which may be NaN (unknown) or infinite. Gives: + - * / abs sqrt min max as
// IEEE 754 defines them, in the order written. Keeps true: under any flags nothing is fused,
// reassociated or assumed finite, since every result passes through rounded(), which is opaque to
// the optimiser. So inf - inf and 0 / 0 are NaN, 1 / 0 is inf, under -ffast-math too, and `etlc
// run` and generated code agree bit for bit. Only -ffast-math at link time changes results: it
// flushes denormals to zero.
#pragma once

#include "etlmon/bits.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

ETLMON_INLINE float add(float a, float b) noexcept {
  return detail::rounded(detail::rounded(a) + detail::rounded(b));
}
ETLMON_INLINE float subtract(float a, float b) noexcept {
  detail::part(a, b);
  return detail::rounded(a - b);
}
ETLMON_INLINE float multiply(float a, float b) noexcept {
  return detail::rounded(detail::rounded(a) * detail::rounded(b));
}
ETLMON_INLINE float divide(float a, float b) noexcept {
  detail::part(a, b);
  return detail::rounded(a / b);
}

ETLMON_INLINE float negate(const float& x) noexcept {
  return detail::from_bits(detail::observe(x) ^ detail::kSignBit);
}
ETLMON_INLINE float absolute(const float& x) noexcept {
  return detail::from_bits(detail::observe(x) & ~detail::kSignBit);
}

/// Returns sqrt, NaN below zero. Infinity and -0 are returned directly: approximations under
/// -ffast-math lose them.
ETLMON_INLINE float root(const float& x) noexcept {
  const uint32_t bits = detail::observe(x);
  if ((bits & ~detail::kSignBit) == 0 || bits == detail::kInfinityBits)
    return detail::from_bits(bits);
  if ((bits & detail::kSignBit) != 0 || bits > detail::kInfinityBits)
    return detail::from_bits(detail::kMissingBits);
  return detail::rounded(detail::square_root(detail::rounded(x)));
}

/// Returns the smaller of two, or NaN if either is NaN. -0 equals +0; of equals, the first is
/// returned.
ETLMON_INLINE float smaller(const float& a, const float& b) noexcept {
  const uint32_t x = detail::observe(a), y = detail::observe(b);
  if (is_nan(a) || is_nan(b)) return detail::from_bits(detail::kMissingBits);
  return detail::from_bits(detail::ordered(y) < detail::ordered(x) ? y : x);
}

/// Returns the greater of two, or NaN if either is NaN. -0 equals +0; of equals, the first is
/// returned.
ETLMON_INLINE float greater(const float& a, const float& b) noexcept {
  const uint32_t x = detail::observe(a), y = detail::observe(b);
  if (is_nan(a) || is_nan(b)) return detail::from_bits(detail::kMissingBits);
  return detail::from_bits(detail::ordered(x) < detail::ordered(y) ? y : x);
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
