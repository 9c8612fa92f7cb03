// SPDX-License-Identifier: MIT
// Embeddings and targets in narrow storage, widened to float32.
// Takes: float16 as their IEEE bits, or int8 and a scale. Gives: one element.
// Keeps true: float16 widens exactly, subnormals, infinities and NaN included; int8 is scale x
// integer, rounded once. Machines that widen by an instruction and those that do not get the same
// bits.
#pragma once

#include "etlmon/bits.hpp"

// ARM machines that convert float16 by an instruction, and a compiler that was not told to mean
// something else by it.
#if defined(__ARM_FP16_FORMAT_IEEE) && defined(__ARM_FP) && (__ARM_FP & 2)
#define ETLMON_HAS_HALVES 1
#endif

namespace etlmon {
inline namespace ETLMON_BUILD {

/// The float32 bits of a float16. Subnormals are scaled by integer arithmetic: no float operation
/// could flush them to zero.
ETLMON_INLINE uint32_t widened_bits(uint16_t half) noexcept {
  const uint32_t sign = (half & 0x8000u) << 16;
  uint32_t exponent = (half >> 10) & 0x1fu;
  uint32_t mantissa = half & 0x3ffu;
  if (exponent == 0x1fu) return sign | detail::kInfinityBits | (mantissa << 13);
  if (exponent == 0) {
    if (mantissa == 0) return sign;
    for (exponent = 1; (mantissa & 0x400u) == 0; --exponent)
      mantissa <<= 1;  // wraps below 0, the sum below does not
    mantissa &= 0x3ffu;
  }
  return sign | ((exponent + 112u) << 23) | (mantissa << 13);
}

namespace detail {

#if !defined(ETLMON_GNU)
/// The same value. Where gnu.hpp is included, a hint how to keep it, for speed.
template <class Type>
ETLMON_INLINE Type in_register(Type x) noexcept {
  return x;
}
ETLMON_INLINE void keep_apart(uint32_t&, uint32_t&, uint32_t&, uint32_t&) noexcept {}
#endif

/// Rows of int8, each worth `scale` times itself: what a pointer is to other rows.
struct ScaledRows {
  const int8_t* values;
  float scale;
};
ETLMON_INLINE ScaledRows operator+(ScaledRows rows, size_t n) noexcept {
  return {rows.values + n, rows.scale};
}
ETLMON_INLINE ScaledRows in_register(ScaledRows rows) noexcept {
  return {in_register(rows.values), rows.scale};
}
ETLMON_INLINE ScaledRows& operator+=(ScaledRows& rows, size_t n) noexcept {
  rows.values += n;
  return rows;
}

/// Element i of rows of any storage, as float32.
ETLMON_INLINE float element(const float* rows, size_t i) noexcept { return rows[i]; }
ETLMON_INLINE float element(const uint16_t* rows, size_t i) noexcept {
#if defined(ETLMON_HAS_HALVES)
  __fp16 half;
  copy_bytes(&half, rows + i, sizeof half);
  return static_cast<float>(half);
#else
  return from_bits(widened_bits(rows[i]));
#endif
}
ETLMON_INLINE float element(ScaledRows rows, size_t i) noexcept {
  return rounded(rows.scale * static_cast<float>(rows.values[i]));
}

/// One row of a set in columns.
template <class Elements>
struct Strided {
  Elements first;
  size_t stride;
};
template <class Elements>
ETLMON_INLINE float element(const Strided<Elements>& row, size_t i) noexcept {
  return element(row.first, i * row.stride);
}

}  // namespace detail

}  // namespace ETLMON_BUILD
}  // namespace etlmon
