// SPDX-License-Identifier: MIT
// Pack: four floats that are added, multiplied and compared together, on machines with vectors of
// 16 bytes. Gives: Pack; whether floats are finite, four at a time; float16 and int8, widened.
// Keeps true: the same operations in the same order on every compiler. The vector extension is used
// because g++ before 12 does not vectorise loops at -O2.
#pragma once

#include "etlmon/bits.hpp"

// A vector of a type that may alias others, from any address.
#define ETLMON_READ(Type, from) (*static_cast<const Type*>(static_cast<const void*>(from)))

#if defined(ETLMON_VECTORS)

// ARM machines with an instruction for IEEE float16.
#if defined(__aarch64__) && defined(__ARM_FP16_FORMAT_IEEE) && (__ARM_FP & 2)
#define ETLMON_WIDENS_HALVES 1
#endif

namespace etlmon {
inline namespace ETLMON_BUILD {
namespace detail {

using Pack = float __attribute__((vector_size(16)));
using PackBits = int32_t __attribute__((vector_size(16)));

/// Returns bits whose sign is set if one of four floats is not finite: adding one carries an
/// exponent of ones into it.
ETLMON_INLINE PackBits not_finite(const float* x) noexcept {
  typedef uint32_t PackExponents __attribute__((vector_size(16)));
  PackExponents bits;
  copy_bytes(&bits, x, sizeof bits);
  return reinterpret_cast<PackBits>((bits & kInfinityBits) + 0x00800000u);
}

/// Returns whether the first n / 4 * 4 floats are finite, and sets `i` to their number.
ETLMON_INLINE bool finite_packs(const float* x, size_t n, size_t& i) noexcept {
  PackBits a{}, b{}, c{}, d{};
  for (; i + 16 <= n; i += 16) {
    a |= not_finite(x + i);
    b |= not_finite(x + i + 4);
    c |= not_finite(x + i + 8);
    d |= not_finite(x + i + 12);
  }
  for (; i + 4 <= n; i += 4) a |= not_finite(x + i);
  a |= b | c | d;
  return (a[0] | a[1] | a[2] | a[3]) >= 0;
}

/// Widens four float16: shifts them as integers to the exponent and mantissa of float32, and adds
/// the difference of the biases, 112, to the exponent; a subnormal is its mantissa times 2^-24,
/// which is exact and never flushed.
ETLMON_INLINE Pack widened(const uint16_t* from) noexcept {
#if defined(ETLMON_WIDENS_HALVES)
  typedef __fp16 Halves __attribute__((vector_size(8)));
  Halves halves;
  copy_bytes(&halves, from, sizeof halves);
  return __builtin_convertvector(halves, Pack);
#else
  const PackBits half = {from[0], from[1], from[2], from[3]};
  const PackBits exponent = half & 0x7c00, mantissa = half & 0x3ff;
  const PackBits special = (exponent == 0x7c00) & (112 << 23);
  const PackBits normal = ((half & 0x7fff) << 13) + (112 << 23) + special;
  const Pack tiny = __builtin_convertvector(mantissa, Pack) * 5.9604644775390625e-8f;
  const PackBits is_tiny = exponent == 0;
  const PackBits bits = (is_tiny & reinterpret_cast<PackBits>(tiny)) | (~is_tiny & normal);
  return reinterpret_cast<Pack>(bits | ((half & 0x8000) << 16));
#endif
}
ETLMON_INLINE Pack scaled(const int8_t* from, float scale) noexcept {
  const PackBits integers = {from[0], from[1], from[2], from[3]};
  Pack product = __builtin_convertvector(integers, Pack) * scale;
#if defined(__aarch64__)
  __asm__("" : "+w"(product));  // rounds here, as detail::rounded does
#else
  __asm__("" : "+x"(product));
#endif
  return product;
}
}  // namespace detail
}  // namespace ETLMON_BUILD
}  // namespace etlmon

#endif
