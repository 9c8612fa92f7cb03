// SPDX-License-Identifier: MIT
// Embeddings and targets in narrow storage, widened to float32. Takes: float16 as their IEEE bits,
// or int8 and a scale. Gives: one element. Keeps true: float16 is widened exactly, with subnormals,
// infinities and NaN; int8 is scale x integer, rounded once. The bits are the same with and without
// an instruction for it.
#pragma once

#include "etlmon/bits.hpp"

// ARM machines with an instruction for IEEE float16.
#if defined(__ARM_FP16_FORMAT_IEEE) && defined(__ARM_FP) && (__ARM_FP & 2)
#define ETLMON_HAS_HALVES 1
#endif

namespace etlmon {
inline namespace ETLMON_BUILD {

/// Returns the float32 bits of a float16. Subnormals are scaled by integer arithmetic, so no float
/// operation flushes them to zero.
ETLMON_INLINE uint32_t widened_bits(uint16_t half) noexcept {
  const uint32_t sign = (half & 0x8000u) << 16;
  uint32_t exponent = (half >> 10) & 0x1fu;
  uint32_t mantissa = half & 0x3ffu;
  if (exponent == 0x1fu) return sign | detail::kInfinityBits | (mantissa << 13);
  if (exponent == 0) {
    if (mantissa == 0) return sign;
    for (exponent = 1; (mantissa & 0x400u) == 0; --exponent)
      mantissa <<= 1;  // may wrap below 0; the sum below does not
    mantissa &= 0x3ffu;
  }
  return sign | ((exponent + 112u) << 23) | (mantissa << 13);
}

namespace detail {

#if !defined(ETLMON_GNU)
/// Returns x. In gnu.hpp it also keeps x in a separate register, for speed.
template <class Type>
ETLMON_INLINE Type in_register(Type x) noexcept {
  return x;
}
ETLMON_INLINE void keep_apart(uint32_t&, uint32_t&, uint32_t&, uint32_t&) noexcept {}
#endif

/// Rows of int8, each element times `scale`, with the interface of a pointer.
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

/// Returns element i of rows of any storage, as float32.
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

/// A row of a set in columns.
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
