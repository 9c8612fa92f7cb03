// SPDX-License-Identifier: MIT
// Selects the best version of the kernel that the CPU and the operating system support. Gives:
// best_of(...), which calls run(...) of that version, and likewise for other functions with
// versions. Keeps true: no version runs on a CPU or operating system that does not support it;
// nothing is written at run time, since the compiler's library (__cpu_model of libgcc or
// compiler-rt) queries the CPU before main(). Without dispatch, also under ETLMON_NO_DISPATCH,
// these are plain calls.
#pragma once

#include "etlmon/vectors/versions.hpp"

#if defined(ETLMON_VECTORS)
namespace etlmon {
inline namespace ETLMON_BUILD {
namespace detail {

#if defined(ETLMON_DISPATCH)
/// Returns the x86-64 level of the CPU, as far as the kernels use it: 1, 3 (AVX2 and FMA; no CPU
/// has these without F16C) or 4 (AVX-512 F, VL, BW, DQ).
ETLMON_INLINE uint32_t x86_64_level() noexcept {
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) return 1;
  const bool wide = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
                    __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq");
  return wide ? 4 : 3;
}
#endif

/// Runs the kernel. Small sets have no third version.
template <class Metric, class Aggregation, class Size, bool InColumns, class Elements>
ETLMON_INLINE MeasuredBits best_run(const float* z, Elements targets, const float* weights,
                                    Size size, Aggregation aggregation) noexcept {
#if defined(ETLMON_DISPATCH)
  const uint32_t level = x86_64_level();
  if constexpr (!Size::is_small(Metric::kDirection)) {
    if (level >= 4) {
      return x86_64_v4::run<Metric, Aggregation, Size, InColumns, Elements>(z, targets, weights,
                                                                            size, aggregation);
    }
  }
  if (level >= 3) {
    return x86_64_v3::run<Metric, Aggregation, Size, InColumns, Elements>(z, targets, weights, size,
                                                                          aggregation);
  }
#endif
  return baseline::run<Metric, Aggregation, Size, InColumns, Elements>(z, targets, weights, size,
                                                                       aggregation);
}
template <class Metric, class Aggregation, class Size, bool InColumns, class Elements>
ETLMON_INLINE Measured best_of(const float* z, Elements targets, const float* weights, Size size,
                               Aggregation aggregation) noexcept {
  return unpacked(
      best_run<Metric, Aggregation, Size, InColumns>(z, targets, weights, size, aggregation));
}

/// Returns 1 / |z|, or 0: inverse_length in run.inc.
template <class Size>
ETLMON_INLINE float best_inverse_length(const float* z) noexcept {
#if defined(ETLMON_DISPATCH)
  const uint32_t level = x86_64_level();
  if constexpr (!Size::is_small(true)) {
    if (level >= 4) return x86_64_v4::inverse_length_of<Size>(z);
  }
  if (level >= 3) return x86_64_v3::inverse_length_of<Size>(z);
#endif
  return baseline::inverse_length_of<Size>(z);
}

/// Computes the values of rows, for dynamic.hpp.
template <class Metric, class Elements>
bool best_row_values(const float* z, Elements targets, const float* weights, uint32_t row,
                     uint32_t end, Sizes size, float* values) noexcept {
#if defined(ETLMON_DISPATCH)
  const uint32_t level = x86_64_level();
  if (level >= 4) return x86_64_v4::row_values<Metric>(z, targets, weights, row, end, size, values);
  if (level >= 3) return x86_64_v3::row_values<Metric>(z, targets, weights, row, end, size, values);
#endif
  return baseline::row_values<Metric>(z, targets, weights, row, end, size, values);
}

/// Searches a large set.
template <class Metric, class Size>
ETLMON_INLINE Measured best_search(const float* z, const float* rows, SearchView state) noexcept {
#if defined(ETLMON_DISPATCH)
  const uint32_t level = x86_64_level();
  if (level >= 4) return unpacked(x86_64_v4::search<Metric, Size>(z, rows, state));
  if (level >= 3) return unpacked(x86_64_v3::search<Metric, Size>(z, rows, state));
#endif
  return unpacked(baseline::search<Metric, Size>(z, rows, state));
}

/// Widens n elements to float32. Few elements do not use vectors of 64 bytes.
template <class Elements>
ETLMON_INLINE void best_widen(Elements from, float* to, uint32_t n) noexcept {
#if defined(ETLMON_DISPATCH)
  const uint32_t level = x86_64_level();
  if (level >= 4 && n > 4 * kLanes) return x86_64_v4::widen(from, to, n);
  if (level >= 3) return x86_64_v3::widen(from, to, n);
#endif
  baseline::widen(from, to, n);
}

}  // namespace detail
}  // namespace ETLMON_BUILD
}  // namespace etlmon

#endif
