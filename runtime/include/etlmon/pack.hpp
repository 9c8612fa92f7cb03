// SPDX-License-Identifier: MIT
// Four floats that are added, multiplied and compared together.
// Takes: pointers to floats of any alignment. Gives: Pack, load, magnitude, larger, rounded, lane<i>.
// Keeps true: the same operations in the same order on every compiler; where the machine has 16-byte vectors of IEEE
// floats (SSE2, AArch64) a Pack is one, written with the vector extension because g++ before 12 vectorises no loop at
// -O2.
#pragma once

#include "etlmon/bits.hpp"

#if defined(__GNUC__) && (defined(__SSE2__) || defined(__aarch64__)) && !defined(ETLMON_NO_PACKS)
#define ETLMON_HAS_PACKS 1
#endif

namespace etlmon {
namespace detail {

#if defined(ETLMON_HAS_PACKS)

using Pack = float __attribute__((vector_size(16)));
using PackBits = int32_t __attribute__((vector_size(16)));
constexpr uint32_t kPacksPerBlock = 4;  ///< independent sums: enough to hide the latency of an addition

ETLMON_INLINE Pack magnitude(Pack x) noexcept {
  return reinterpret_cast<Pack>(reinterpret_cast<PackBits>(x) & 0x7fffffff);
}
ETLMON_INLINE Pack larger(Pack a, Pack b) noexcept {
#if defined(__clang__)  // before 11 it has no ?: for vectors; it finds the maximum in either form, g++ only in the
                        // other
  const PackBits which = a > b;
  return reinterpret_cast<Pack>((which & reinterpret_cast<PackBits>(a)) | (~which & reinterpret_cast<PackBits>(b)));
#else
  return a > b ? a : b;
#endif
}
template <uint32_t I>
ETLMON_INLINE float lane(Pack x) noexcept {
  return x[I];
}
ETLMON_INLINE Pack rounded(Pack x) noexcept {
#if defined(__aarch64__)
  __asm__("" : "+w"(x));
#else
  __asm__("" : "+x"(x));
#endif
  return x;
}

#else

struct Pack {
  float a, b, c, d;
};
constexpr uint32_t kPacksPerBlock = 1;  ///< scalar machines have few registers and little latency

ETLMON_INLINE Pack operator+(Pack x, Pack y) noexcept { return {x.a + y.a, x.b + y.b, x.c + y.c, x.d + y.d}; }
ETLMON_INLINE Pack operator-(Pack x, Pack y) noexcept { return {x.a - y.a, x.b - y.b, x.c - y.c, x.d - y.d}; }
ETLMON_INLINE Pack operator*(Pack x, Pack y) noexcept { return {x.a * y.a, x.b * y.b, x.c * y.c, x.d * y.d}; }
ETLMON_INLINE Pack operator*(Pack x, float s) noexcept { return {x.a * s, x.b * s, x.c * s, x.d * s}; }

#endif

ETLMON_INLINE float magnitude(float x) noexcept {
  uint32_t bits = 0;
  copy_bytes(&bits, &x, sizeof bits);
  return from_bits(bits & ~kSignBit);
}
ETLMON_INLINE float larger(float a, float b) noexcept { return a > b ? a : b; }

#if !defined(ETLMON_HAS_PACKS)
ETLMON_INLINE Pack magnitude(Pack x) noexcept {
  return {magnitude(x.a), magnitude(x.b), magnitude(x.c), magnitude(x.d)};
}
ETLMON_INLINE Pack larger(Pack x, Pack y) noexcept {
  return {larger(x.a, y.a), larger(x.b, y.b), larger(x.c, y.c), larger(x.d, y.d)};
}
ETLMON_INLINE Pack rounded(Pack x) noexcept { return {rounded(x.a), rounded(x.b), rounded(x.c), rounded(x.d)}; }
template <uint32_t I>
ETLMON_INLINE float lane(Pack x) noexcept {
  return I == 0 ? x.a : I == 1 ? x.b : I == 2 ? x.c : x.d;
}
#endif

template <class V>
ETLMON_INLINE V load(const float* x) noexcept {
  V v{};
  copy_bytes(&v, x, sizeof v);
  return v;
}

}  // namespace detail
}  // namespace etlmon
