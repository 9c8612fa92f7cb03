// SPDX-License-Identifier: MIT
// Whole embeddings in narrow storage, widened to float32 before they are measured.
// Takes: n float16 as their IEEE bits, or n int8 and what one of them is worth. Gives: n floats.
// Keeps true: the bits of storage.hpp's element(), by the instructions that the CPU has (vcvtph2ps,
// vpmovsxbd), chosen as kernels are.
#pragma once

#include "etlmon/distance/storage.hpp"
#if defined(ETLMON_VECTORS)
#include "etlmon/distance/best.hpp"
#endif

namespace etlmon {
inline namespace ETLMON_BUILD {
namespace detail {

#if defined(ETLMON_VECTORS)
template <class Elements>
ETLMON_INLINE void widen(Elements from, float* to, uint32_t n) noexcept {
  best_widen(from, to, n);
}
#else
template <class Elements>
ETLMON_INLINE void widen(Elements from, float* to, uint32_t n) noexcept {
  for (uint32_t i = 0; i < n; ++i) to[i] = element(from, i);
}
#endif

}  // namespace detail

ETLMON_INLINE void widen_f16(const uint16_t* from, float* to, uint32_t n) noexcept {
  detail::widen(from, to, n);
}

ETLMON_INLINE void widen_i8(const int8_t* from, float scale, float* to, uint32_t n) noexcept {
  detail::widen(detail::ScaledRows{from, scale}, to, n);
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
