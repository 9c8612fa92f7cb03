// SPDX-License-Identifier: MIT
// What g++ and clang offer beyond the standard, on machines that the runtime knows: statements that
// hide a value from the optimiser without an instruction, the square root's own instruction, and
// whether there are vectors. Gives: ETLMON_GNU; detail::opaque, in_register, keep_apart, part,
// square_root; ETLMON_VECTORS, where vectors/ is compiled. Keeps true: the same values as without,
// bit for bit; bits.hpp includes it, and ETLMON_PORTABLE leaves it out.
#pragma once

#include <stdint.h>

#include "etlmon/build.hpp"

#define ETLMON_GNU 1
#if defined(__SSE2__) || defined(__aarch64__)
#define ETLMON_VECTORS 1
#endif

// A register that floats are kept in, as an operand of asm.
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

/// The same value, of which the optimiser knows nothing.
ETLMON_INLINE float opaque(float x) noexcept {
  __asm__("" : "+" ETLMON_FLOAT_REGISTER(x));
  return x;
}
ETLMON_INLINE uint32_t opaque(uint32_t x) noexcept {
  __asm__("" : "+r"(x));
  return x;
}
/// A pointer to memory of which it knows nothing either.
ETLMON_INLINE const float* opaque(const float* x) noexcept {
  __asm__("" : "+r"(x) : : "memory");
  return x;
}

/// Two floats as two that nothing is known of, not even whether they are the same: under
/// -ffast-math x - x is 0 and x / x is 1, whatever x is.
ETLMON_INLINE void part(float& x, float& y) noexcept {
  __asm__("" : "+" ETLMON_FLOAT_REGISTER(x), "+" ETLMON_FLOAT_REGISTER(y));
}

/// The same value in a register of its own, for speed: g++ jumps around a constant; a pointer then
/// moves along by itself, which small machines do while they load, and is not computed from another
/// one for every element.
template <class Type>
ETLMON_INLINE Type in_register(Type x) noexcept {
  __asm__("" : "+r"(x));
  return x;
}

/// The same, of four; where a vector holds them it would not pay.
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

/// sqrt of a float that is not negative, rounded once. By the instruction on x86, where a compiler
/// would add a call of the library's for the sake of errno, and with -ffast-math an approximation;
/// clang does under any name but this.
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
