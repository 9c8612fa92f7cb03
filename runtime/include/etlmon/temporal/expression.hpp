// SPDX-License-Identifier: MIT
// Arithmetic of EXPR predicates: each operation rounded once to float32, and a NaN operand always
// gives NaN. Takes: floats, any of them NaN (unknown) or infinite. Gives: + - * / abs sqrt min max
// as IEEE 754 says, in the order written. Keeps true: no fusing, no reassociation, no assumption
// that a value is finite, whatever the flags: every result passes through rounded(), which the
// optimiser cannot see into. So inf - inf and 0 / 0 are NaN, 1 / 0 is inf, under -ffast-math too,
// and `etlc run` and generated code agree bit for bit. With -ffast-math at link time denormals are
// flushed to zero: that, and nothing else, still changes results.
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

/// sqrt; NaN below zero. Infinity and -0 are returned as they are: estimates that -ffast-math may
/// use lose them.
ETLMON_INLINE float root(const float& x) noexcept {
  const uint32_t bits = detail::observe(x);
  if ((bits & ~detail::kSignBit) == 0 || bits == detail::kInfinityBits)
    return detail::from_bits(bits);
  if ((bits & detail::kSignBit) != 0 || bits > detail::kInfinityBits)
    return detail::from_bits(detail::kMissingBits);
  return detail::rounded(detail::square_root(detail::rounded(x)));
}

/// The smaller of two; NaN if either is. -0 counts as equal to +0, and then the first is returned.
ETLMON_INLINE float smaller(const float& a, const float& b) noexcept {
  const uint32_t x = detail::observe(a), y = detail::observe(b);
  if (is_nan(a) || is_nan(b)) return detail::from_bits(detail::kMissingBits);
  return detail::from_bits(detail::ordered(y) < detail::ordered(x) ? y : x);
}

/// The greater of two; NaN if either is. -0 counts as equal to +0, and then the first is returned.
ETLMON_INLINE float greater(const float& a, const float& b) noexcept {
  const uint32_t x = detail::observe(a), y = detail::observe(b);
  if (is_nan(a) || is_nan(b)) return detail::from_bits(detail::kMissingBits);
  return detail::from_bits(detail::ordered(x) < detail::ordered(y) ? y : x);
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
