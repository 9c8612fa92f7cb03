// SPDX-License-Identifier: MIT
// Embeddings in narrow storage, widened to float32.
// Takes: float16 as their IEEE bits, or int8 and a scale. Gives: n floats.
// Keeps true: float16 widens exactly, subnormals, infinities and NaN included; int8 is scale x integer, rounded once.
#pragma once

#include "etlmon/bits.hpp"

namespace etlmon {

/// The float32 bits of a float16. Subnormals are scaled by integer arithmetic: no float operation could flush them to
/// zero.
ETLMON_INLINE uint32_t widened_bits(uint16_t half) noexcept {
  const uint32_t sign = (half & 0x8000u) << 16;
  uint32_t exponent = (half >> 10) & 0x1fu;
  uint32_t mantissa = half & 0x3ffu;
  if (exponent == 0x1fu) return sign | detail::kInfinityBits | (mantissa << 13);
  if (exponent == 0) {
    if (mantissa == 0) return sign;
    for (exponent = 1; (mantissa & 0x400u) == 0; --exponent) mantissa <<= 1;  // wraps below 0, the sum below does not
    mantissa &= 0x3ffu;
  }
  return sign | ((exponent + 112u) << 23) | (mantissa << 13);
}

inline void widen_f16(const uint16_t* from, float* to, uint32_t n) noexcept {
  for (uint32_t i = 0; i < n; ++i) to[i] = detail::from_bits(widened_bits(from[i]));
}

inline void widen_i8(const int8_t* from, float scale, float* to, uint32_t n) noexcept {
  for (uint32_t i = 0; i < n; ++i) to[i] = detail::rounded(scale * static_cast<float>(from[i]));
}

}  // namespace etlmon
