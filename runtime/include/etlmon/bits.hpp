// SPDX-License-Identifier: MIT
// Tests of floats by their bits: NaN, infinite or missing, even under -ffast-math. Takes: floats
// from memory or from arithmetic. Gives: exact answers from bits, one rounding per operation, sqrt.
// Keeps true: no decision depends on a floating-point comparison that -ffinite-math-only may
// remove. Functions that may see a NaN or an infinity are always inlined or take references: clang
// marks float parameters of other functions "never NaN" under that flag. Builtins are called by
// name so that -ffreestanding, which makes memcpy a plain function, still gets single moves.
#pragma once

#include <float.h>
#include <stddef.h>
#include <stdint.h>

#include "etlmon/build.hpp"

#if !defined(__GNUC__)  // without builtins; in C++, math.h takes longer to compile than the rest of
                        // a monitor
#include <math.h>
#include <string.h>
#endif

// Extensions of g++ and clang; all code below has an alternative in standard C++.
#if defined(__GNUC__) && !defined(ETLMON_PORTABLE)
#include "etlmon/gnu.hpp"
#endif

namespace etlmon {
inline namespace ETLMON_BUILD {

/// The value of a missing sample: a quiet NaN.
#if defined(__has_builtin)
#if __has_builtin(__builtin_bit_cast)
#define ETLMON_HAS_BIT_CAST 1
#endif
#endif
#if defined(ETLMON_HAS_BIT_CAST)
constexpr float kMissing = __builtin_bit_cast(float, 0x7fc00000u);
constexpr float kInfinite = __builtin_bit_cast(float, 0x7f800000u);
#elif defined(__GNUC__)
constexpr float kMissing = __builtin_nanf("");
constexpr float kInfinite = __builtin_inff();
#else
constexpr float kMissing = NAN;
constexpr float kInfinite = INFINITY;
#endif

namespace detail {

constexpr uint32_t kSignBit = 0x80000000u;
constexpr uint32_t kInfinityBits = 0x7f800000u;
constexpr uint32_t kMissingBits = 0x7fc00000u;

// Without optimisation GCC warns of reads in loops that a short row never enters.
#if defined(__GNUC__) && !defined(__clang__) && __GNUC__ >= 11
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wstringop-overread"
#endif
ETLMON_INLINE void copy_bytes(void* to, const void* from, size_t bytes) noexcept {
#if defined(__GNUC__)
  __builtin_memcpy(to, from, bytes);
#else
  memcpy(to, from, bytes);
#endif
}
#if defined(__GNUC__) && !defined(__clang__) && __GNUC__ >= 11
#pragma GCC diagnostic pop
#endif

#if !defined(ETLMON_GNU)
/// Returns x, hidden from the optimiser by a volatile copy.
template <class Type>
ETLMON_INLINE Type opaque(Type x) noexcept {
  const volatile Type kept = x;
  return kept;
}
#endif

/// Returns the bits of a computed float. Under -ffinite-math-only they are hidden from the
/// compiler, which would otherwise conclude from the arithmetic that they are not those of a NaN or
/// an infinity.
ETLMON_INLINE uint32_t observe(const float& x) noexcept {
#if defined(ETLMON_HAS_BIT_CAST)  // tells the compiler that x is aligned
  uint32_t bits = __builtin_bit_cast(uint32_t, x);
#else
  uint32_t bits = 0;
  copy_bytes(&bits, &x, sizeof bits);
#endif
#if defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__
  bits = opaque(bits);
#endif
  return bits;
}

ETLMON_INLINE float from_bits(uint32_t bits) noexcept {
  float x = 0.0f;
  copy_bytes(&x, &bits, sizeof x);
  return x;
}

/// Maps the bits of floats to integers in the order of the floats. -0 and +0 are equal; NaN lies
/// beyond the infinities. Without a branch unless optimised for size, since the signs of robustness
/// are unpredictable.
ETLMON_INLINE constexpr int32_t ordered(uint32_t bits) noexcept {
#if defined(__OPTIMIZE_SIZE__)
  return static_cast<int32_t>(bits >= kSignBit ? kSignBit - bits : bits);
#else
  const uint32_t negative = 0u - (bits >> 31);  // all ones, or none
  return static_cast<int32_t>(((bits & ~kSignBit) ^ negative) - negative);
#endif
}

/// Returns x rounded to float32: not fused or reassociated with later operations, and not assumed
/// finite.
ETLMON_INLINE float rounded(float x) noexcept { return opaque(x); }

#if !defined(ETLMON_GNU)
/// Hides two floats from the optimiser, even that they are equal: under -ffast-math x - x is 0 and
/// x / x is 1 for every x.
ETLMON_INLINE void part(float& x, float& y) noexcept {
  x = opaque(x);
  y = opaque(y);
}

/// Returns sqrt of a float that is not negative.
ETLMON_INLINE float square_root(float x) noexcept {
#if defined(__GNUC__)
  return __builtin_sqrtf(x);
#else
  return sqrtf(x);
#endif
}
#endif

}  // namespace detail

ETLMON_INLINE bool is_nan(const float& x) noexcept {
  return (detail::observe(x) << 1) > (detail::kInfinityBits << 1);  // shifts the sign out
}

ETLMON_INLINE bool is_finite(const float& x) noexcept {
  return (detail::observe(x) << 1) < (detail::kInfinityBits << 1);
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
