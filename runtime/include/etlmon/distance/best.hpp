// SPDX-License-Identifier: MIT
// Selects the kernel: best<...>(). Gives: the kernels of vectors/ if the machine has vectors,
// otherwise `baseline`, which measures element by element. Keeps true: only this file and views.hpp
// include vectors/, and not on machines without vectors.
#pragma once

#include "etlmon/distance/storage.hpp"
#include "etlmon/distance/tally.hpp"

#if defined(ETLMON_VECTORS)
#include "etlmon/vectors/dispatch.hpp"
#else

namespace etlmon {
inline namespace ETLMON_BUILD {
namespace detail {

#define ETLMON_TARGET
#define ETLMON_WIDE ETLMON_INLINE
#if defined(__FP_FAST_FMAF)
#define ETLMON_FUSED 1
#endif
namespace baseline {
// clang-format off
#include "etlmon/distance/terms.inc"
#include "etlmon/distance/rows.inc"
#include "etlmon/distance/scalars.inc"
#include "etlmon/distance/run.inc"
// clang-format on
}  // namespace baseline
#undef ETLMON_FUSED
#undef ETLMON_WIDE
#undef ETLMON_TARGET

template <class Metric, class Aggregation, class Size, bool InColumns, class Elements>
ETLMON_INLINE Measured best_of(const float* z, Elements targets, const float* weights, Size size,
                               Aggregation aggregation) noexcept {
  return unpacked(baseline::run<Metric, Aggregation, Size, InColumns, Elements>(z, targets, weights,
                                                                                size, aggregation));
}

/// Returns 1 / |z|, or 0: inverse_length in run.inc.
template <class Size>
ETLMON_INLINE float best_inverse_length(const float* z) noexcept {
  return baseline::inverse_length_of<Size>(z);
}

}  // namespace detail
}  // namespace ETLMON_BUILD
}  // namespace etlmon

#endif

namespace etlmon {
inline namespace ETLMON_BUILD {
namespace detail {

/// Runs the kernel on rows or columns; on int8 with their scale.
template <class Metric, class Aggregation, class Size, bool InColumns, class Elements>
ETLMON_INLINE Measured best(const float* z, const Elements* targets, const float* weights,
                            Size size, Aggregation aggregation) noexcept {
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
