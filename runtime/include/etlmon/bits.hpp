// SPDX-License-Identifier: MIT
// Floats whose bits decide: what is NaN, infinite or missing, whatever -ffast-math lets a compiler
// assume. Takes: floats from memory or fresh from arithmetic. Gives: exact answers from bits, one
// rounding per operation, sqrt. Keeps true: no decision rests on a floating-point comparison that
// -ffinite-math-only may fold away. Functions that may see a NaN or an infinity are inlined always
// or take references: clang marks float parameters of others "never NaN" there. Builtins are called
// by name so that -ffreestanding, which makes memcpy a plain function, still gets single moves.
#pragma once

#include <float.h>
#include <stddef.h>
#include <stdint.h>

#include "etlmon/build.hpp"

#if !defined(__GNUC__)  // where there are no builtins; in C++, math.h takes longer to read than the
                        // rest of a monitor
#include <math.h>
#include <string.h>
#endif

// What g++ and clang offer beyond the standard; everything below does without.
#if defined(__GNUC__) && !defined(ETLMON_PORTABLE)
#include "etlmon/gnu.hpp"
#endif

namespace etlmon {
inline namespace ETLMON_BUILD {

/// What a sample that is not there looks like: a quiet NaN.
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

// Without optimisation GCC warns of reads in loops over whole vectors that a short row never
// enters.
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
/// The same value, of which the optimiser knows nothing: read back from memory that it must not
/// look through.
template <class Type>
ETLMON_INLINE Type opaque(Type x) noexcept {
  const volatile Type kept = x;
  return kept;
}
#endif

/// The bits of a float that arithmetic made. Where NaN and infinity are assumed away, the compiler
/// is kept from seeing where the bits come from: it must not conclude from the arithmetic what they
/// cannot be.
ETLMON_INLINE uint32_t observe(const float& x) noexcept {
#if defined(ETLMON_HAS_BIT_CAST)  // unlike copy_bytes it tells the compiler that x is aligned
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

/// An integer that orders floats by value, given their bits; -0 and +0 are one, NaN lies beyond the
/// infinities. Where speed counts without a branch, since the signs of robustness are what no
/// processor predicts.
ETLMON_INLINE constexpr int32_t ordered(uint32_t bits) noexcept {
#if defined(__OPTIMIZE_SIZE__)
  return static_cast<int32_t>(bits >= kSignBit ? kSignBit - bits : bits);
#else
  const uint32_t negative = 0u - (bits >> 31);  // all ones, or none
  return static_cast<int32_t>(((bits & ~kSignBit) ^ negative) - negative);
#endif
}

/// x, rounded to float32 here: not fused with what follows, not reassociated with it, not assumed
/// finite.
ETLMON_INLINE float rounded(float x) noexcept { return opaque(x); }

#if !defined(ETLMON_GNU)
/// Two floats as two that nothing is known of, not even whether they are the same: under
/// -ffast-math x - x is 0 and x / x is 1, whatever x is.
ETLMON_INLINE void part(float& x, float& y) noexcept {
  x = opaque(x);
  y = opaque(y);
}

/// sqrt of a float that is not negative.
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
  return (detail::observe(x) << 1) > (detail::kInfinityBits << 1);  // without the sign
}

ETLMON_INLINE bool is_finite(const float& x) noexcept {
  return (detail::observe(x) << 1) < (detail::kInfinityBits << 1);
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
