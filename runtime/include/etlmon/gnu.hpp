// SPDX-License-Identifier: MIT
// Extensions of g++ and clang on known machines: statements that hide a value from the optimiser
// without an instruction, the square root instruction, and the presence of vectors. Gives:
// ETLMON_GNU; detail::opaque, in_register, keep_apart, part, square_root; ETLMON_VECTORS, where
// vectors/ is compiled. Keeps true: the same results, bit for bit, as without this file. bits.hpp
// includes it unless ETLMON_PORTABLE is defined.
#pragma once

#include <stdint.h>

#include "etlmon/build.hpp"

#define ETLMON_GNU 1
#if defined(__SSE2__) || defined(__aarch64__)
#define ETLMON_VECTORS 1
#endif

// The asm constraint of a float register.
#if defined(__SSE__)
#define ETLMON_FLOAT_REGISTER "x"
#elif defined(__aarch64__)
#define ETLMON_FLOAT_REGISTER "w"
#elif defined(__arm__) && defined(__ARM_FP)
#define ETLMON_FLOAT_REGISTER "t"
#elif defined(__riscv_flen)
#define ETLMON_FLOAT_REGISTER "f"
#else
#define ETLMON_FLOAT_REGISTER "m"
#endif

namespace etlmon {
inline namespace ETLMON_BUILD {
namespace detail {

/// Returns x, hidden from the optimiser.
ETLMON_INLINE float opaque(float x) noexcept {
  __asm__("" : "+" ETLMON_FLOAT_REGISTER(x));
  return x;
}
ETLMON_INLINE uint32_t opaque(uint32_t x) noexcept {
  __asm__("" : "+r"(x));
  return x;
}
/// Returns x, hidden from the optimiser together with the memory that it points to.
ETLMON_INLINE const float* opaque(const float* x) noexcept {
  __asm__("" : "+r"(x) : : "memory");
  return x;
}

/// Hides two floats from the optimiser, even that they are equal: under -ffast-math x - x is 0 and
/// x / x is 1 for every x.
ETLMON_INLINE void part(float& x, float& y) noexcept {
  __asm__("" : "+" ETLMON_FLOAT_REGISTER(x), "+" ETLMON_FLOAT_REGISTER(y));
}

/// Returns x in a separate register, for speed. g++ branches around constants; and a pointer in a
/// register is incremented, which small machines do during the load, not computed for every
/// element.
template <class Type>
ETLMON_INLINE Type in_register(Type x) noexcept {
  __asm__("" : "+r"(x));
  return x;
}

/// Keeps four values in separate registers, unless there are vectors.
ETLMON_INLINE void keep_apart(uint32_t& a, uint32_t& b, uint32_t& c, uint32_t& d) noexcept {
#if !defined(ETLMON_VECTORS)
  __asm__("" : "+r"(a), "+r"(b), "+r"(c), "+r"(d));
#else
  (void)a, (void)b, (void)c, (void)d;
#endif
}

#if defined(__SSE__) && defined(__has_builtin)
#if __has_builtin(__builtin_ia32_sqrtss)
#define ETLMON_HAS_SQRTSS 1
#endif
#endif

/// Returns sqrt of a float that is not negative, rounded once. On x86 by the instruction: compilers
/// add a library call that sets errno, or with -ffast-math an approximation, which clang avoids
/// only for this builtin.
ETLMON_INLINE float square_root(float x) noexcept {
#if defined(__clang__) && defined(__SSE__) && defined(__FAST_MATH__)
#if defined(__AVX__)
  __asm__("vsqrtss %0, %0, %0" : "+x"(x));
#else
  __asm__("sqrtss %0, %0" : "+x"(x));
#endif
  return x;
#elif defined(ETLMON_HAS_SQRTSS)
  using Four = float __attribute__((vector_size(16)));
  return __builtin_ia32_sqrtss(Four{x})[0];
#else
  return __builtin_sqrtf(x);
#endif
}

}  // namespace detail
}  // namespace ETLMON_BUILD
}  // namespace etlmon

#undef ETLMON_FLOAT_REGISTER
