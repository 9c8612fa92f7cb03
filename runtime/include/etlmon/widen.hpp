// SPDX-License-Identifier: MIT
// Whole embeddings in narrow storage, widened to float32 before they are measured.
// Takes: n float16 as their IEEE bits, or n int8 and what one of them is worth. Gives: n floats.
// Keeps true: the bits of storage.hpp's element(), by the instructions that the CPU has (vcvtph2ps,
// vpmovsxbd), chosen as kernels are.
#pragma once

#include "etlmon/dispatch.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {
namespace detail {

/// Few elements do without vectors of 64 bytes.
template <class G, bool Few>
struct WideningVersions {
  ETLMON_INLINE static auto choice() noexcept {
#if defined(ETLMON_DISPATCH)
    const uint32_t level = x86_64_level();
    if constexpr (!Few) {
      if (level >= 4) return x86_64_v4::widen<G>;
    }
#if ETLMON_X86_64 < 3
    if (level >= 3) return x86_64_v3::widen<G>;
#endif
#endif
    return baseline::widen<G>;
  }
};

template <class G>
ETLMON_INLINE void widen(G from, float* to, uint32_t n) noexcept {
  using Function = void(G, float*, uint32_t);
  if (n <= 4 * kLanes) return Dispatch<WideningVersions<G, true>, Function>::call(from, to, n);
  Dispatch<WideningVersions<G, false>, Function>::call(from, to, n);
}

}  // namespace detail

ETLMON_INLINE void widen_f16(const uint16_t* from, float* to, uint32_t n) noexcept {
  detail::widen(from, to, n);
}

ETLMON_INLINE void widen_i8(const int8_t* from, float scale, float* to, uint32_t n) noexcept {
  detail::widen(detail::ScaledRows{from, scale}, to, n);
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
