// SPDX-License-Identifier: MIT
// Which version of the kernel runs: the best that the CPU and the operating system have.
// Takes: nothing; asks the CPU once. Gives: best(...), a call of that version's run(...). Keeps
// true: on hosted x86-64 one constant-initialised pointer per kernel, which changes once, to a
// value that is the same whichever thread writes it; elsewhere, and under ETLMON_NO_DISPATCH, a
// plain call.
#pragma once

#include "etlmon/versions.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {
namespace detail {

#if defined(ETLMON_DISPATCH)

struct CpuId {
  uint32_t a, b, c, d;
};
inline CpuId cpu_id(uint32_t leaf) noexcept {
  CpuId id{};
  __asm__("cpuid" : "=a"(id.a), "=b"(id.b), "=c"(id.c), "=d"(id.d) : "a"(leaf), "c"(0));
  return id;
}

/// The x86-64 level of the CPU as far as the kernels use it: 1, 3 (AVX2, FMA, F16C) or 4 (AVX-512
/// F, VL, BW, DQ), where the operating system keeps the registers. (Intel 64 and IA-32
/// Architectures Software Developer's Manual, volume 1, sections 14.3 and 15.2.)
ETLMON_COLD inline uint32_t x86_64_level() noexcept {
  constexpr uint32_t kFma = 1u << 12, kOsxsave = 1u << 27, kAvx = 1u << 28, kF16c = 1u << 29;
  constexpr uint32_t kAvx2 = 1u << 5, kAvx512 = 1u << 16 | 1u << 17 | 1u << 30 | 1u << 31;
  constexpr uint32_t kYmm = 0x6, kZmm = 0xe6;
  constexpr uint32_t kLevel3 = kFma | kOsxsave | kAvx | kF16c;
  if (cpu_id(0).a < 7 || (cpu_id(1).c & kLevel3) != kLevel3) return 1;
  uint32_t kept = 0, high = 0;
  __asm__("xgetbv" : "=a"(kept), "=d"(high) : "c"(0));
  const uint32_t has = cpu_id(7).b;
  if ((has & kAvx2) == 0 || (kept & kYmm) != kYmm) return 1;
  return (has & kAvx512) == kAvx512 && (kept & kZmm) == kZmm ? 4 : 3;
}

#endif

/// A function of which there is a version per instruction set. Versions::choice() gives the best
/// one; the CPU is asked for it at the first call, where there is a choice.
template <class Versions, class Function>
struct Dispatch;
template <class Versions, class Result, class... Arguments>
struct Dispatch<Versions, Result(Arguments...)> {
#if defined(ETLMON_DISPATCH)
  using Run = Result (*)(Arguments...) noexcept;

  ETLMON_COLD static Result choose(Arguments... arguments) noexcept {
    const Run run = Versions::choice();
    __atomic_store_n(&chosen, run, __ATOMIC_RELAXED);
    return run(arguments...);
  }
  inline static Run chosen = choose;
  ETLMON_INLINE static Result call(Arguments... arguments) noexcept {
    return __atomic_load_n(&chosen, __ATOMIC_RELAXED)(arguments...);
  }
#else
  ETLMON_INLINE static Result call(Arguments... arguments) noexcept {
    return Versions::choice()(arguments...);
  }
#endif
};

template <class Metric, class Aggregation, class Size, bool InColumns, class G>
struct KernelVersions {
  ETLMON_INLINE static auto choice() noexcept {
#if defined(ETLMON_DISPATCH)
    const uint32_t level = x86_64_level();
    if constexpr (!Size::is_small(Metric::kDirection)) {
      if (level >= 4) return x86_64_v4::run<Metric, Aggregation, Size, InColumns, G>;
    }
#if ETLMON_X86_64 < 3
    if (level >= 3) return x86_64_v3::run<Metric, Aggregation, Size, InColumns, G>;
#endif
#endif
    return baseline::run<Metric, Aggregation, Size, InColumns, G>;
  }
};
template <class Metric, class Aggregation, class Size, bool InColumns, class G>
ETLMON_INLINE Measured best_of(const float* z, G targets, const float* weights, Size size,
                               Aggregation aggregation) noexcept {
  using Function = MeasuredBits(const float*, G, const float*, Size, Aggregation);
  using Kernel = Dispatch<KernelVersions<Metric, Aggregation, Size, InColumns, G>, Function>;
  return unpacked(Kernel::call(z, targets, weights, size, aggregation));
}

template <class Size>
struct LengthVersions {
  ETLMON_INLINE static auto choice() noexcept {
#if defined(ETLMON_DISPATCH)
    const uint32_t level = x86_64_level();
    if constexpr (!Size::is_small(true)) {
      if (level >= 4) return x86_64_v4::inverse_length_of<Size>;
    }
#if ETLMON_X86_64 < 3
    if (level >= 3) return x86_64_v3::inverse_length_of<Size>;
#endif
#endif
    return baseline::inverse_length_of<Size>;
  }
};
/// 1 / |z|, or 0: inverse_length in run.inc.
template <class Size>
ETLMON_INLINE float best_inverse_length(const float* z) noexcept {
  return Dispatch<LengthVersions<Size>, float(const float*)>::call(z);
}

/// The kernel on rows, or columns, of T; on int8 with their scale.
template <class Metric, class Aggregation, class Size, bool InColumns, class T>
ETLMON_INLINE Measured best(const float* z, const T* targets, const float* weights, Size size,
                            Aggregation aggregation) noexcept {
  return best_of<Metric, Aggregation, Size, InColumns>(z, targets, weights, size, aggregation);
}
template <class Metric, class Aggregation, class Size, bool InColumns>
ETLMON_INLINE Measured best(const float* z, ScaledRows targets, const float* weights, Size size,
                            Aggregation aggregation) noexcept {
  return best_of<Metric, Aggregation, Size, InColumns>(z, targets, weights, size, aggregation);
}

}  // namespace detail
}  // namespace ETLMON_BUILD
}  // namespace etlmon
