// SPDX-License-Identifier: MIT
// Whole embeddings in narrow storage, widened to float32 before they are measured.
// Takes: n float16 as their IEEE bits, or n int8 and what one of them is worth. Gives: n floats. Keeps true: the bits
// of storage.hpp's element(), by the instructions that the CPU has (vcvtph2ps, vpmovsxbd), chosen as kernels are.
#pragma once

#include "etlmon/dispatch.hpp"

namespace etlmon {
namespace detail {

#if defined(ETLMON_DISPATCH)

template <class G, bool Small>
struct Widening {
  using Run = void (*)(G, float*, uint32_t) noexcept;

  static Run choice() noexcept {
    const uint32_t level = x86_64_level();
    if constexpr (!Small) {
      if (level >= 4) return x86_64_v4::widen<G>;
    }
#if ETLMON_X86_64 < 3
    if (level >= 3) return x86_64_v3::widen<G>;
#endif
    return baseline::widen<G>;
  }
  ETLMON_COLD static void choose(G from, float* to, uint32_t n) noexcept {
    const Run run = choice();
    __atomic_store_n(&chosen, run, __ATOMIC_RELAXED);
    run(from, to, n);
  }
  inline static Run chosen = choose;
};

template <class G>
ETLMON_INLINE void widen(G from, float* to, uint32_t n) noexcept {
  if (n <= 4 * kLanes) {
    __atomic_load_n(&Widening<G, true>::chosen, __ATOMIC_RELAXED)(from, to, n);
  } else {
    __atomic_load_n(&Widening<G, false>::chosen, __ATOMIC_RELAXED)(from, to, n);
  }
}

#else

template <class G>
ETLMON_INLINE void widen(G from, float* to, uint32_t n) noexcept {
  baseline::widen<G>(from, to, n);
}

#endif

}  // namespace detail

ETLMON_INLINE void widen_f16(const uint16_t* from, float* to, uint32_t n) noexcept { detail::widen(from, to, n); }

ETLMON_INLINE void widen_i8(const int8_t* from, float scale, float* to, uint32_t n) noexcept {
  detail::widen(detail::ScaledRows{from, scale}, to, n);
}

}  // namespace etlmon
