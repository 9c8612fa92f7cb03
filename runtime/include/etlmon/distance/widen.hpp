// SPDX-License-Identifier: MIT
// Widens embeddings in narrow storage to float32 before they are measured. Takes: n float16 as IEEE
// bits, or n int8 and their scale. Gives: n floats. Keeps true: the bits of element() in
// storage.hpp, by instructions of the CPU (vcvtph2ps, vpmovsxbd), which are selected as for
// kernels.
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
