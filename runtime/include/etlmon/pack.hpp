// SPDX-License-Identifier: MIT
// What the machine that the program is built for has: 16-byte vectors of floats, or scalars only.
// Takes: the compiler's macros. Gives: ETLMON_HAS_PACKS; Pack, four floats that are added,
// multiplied and compared together; magnitude, larger and rounded for scalars. Keeps true: written
// with the vector extension because g++ before 12 vectorises no loop at -O2; the same operations in
// the same order on every compiler.
#pragma once

#include "etlmon/bits.hpp"

#if defined(__GNUC__) && (defined(__SSE2__) || defined(__aarch64__)) && !defined(ETLMON_NO_PACKS)
#define ETLMON_HAS_PACKS 1
#endif

// A vector of a type that may alias others, from any address.
#define ETLMON_READ(Type, from) (*static_cast<const Type*>(static_cast<const void*>(from)))

namespace etlmon {
inline namespace ETLMON_BUILD {
namespace detail {

#if defined(ETLMON_HAS_PACKS)
using Pack = float __attribute__((vector_size(16)));
using PackBits = int32_t __attribute__((vector_size(16)));
constexpr bool kHasPacks = true;
#else
constexpr bool kHasPacks = false;
#endif

ETLMON_INLINE float magnitude(float x) noexcept {
  uint32_t bits = 0;
  copy_bytes(&bits, &x, sizeof bits);
  return from_bits(bits & ~kSignBit);
}
ETLMON_INLINE float larger(float a, float b) noexcept { return a > b ? a : b; }

}  // namespace detail
}  // namespace ETLMON_BUILD
}  // namespace etlmon
