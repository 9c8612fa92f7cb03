// SPDX-License-Identifier: MIT
// Thresholds that follow delayed labels, in one number and constant time. Takes: the distance of a
// truly positive frame, and the current threshold. Gives: the next threshold, by quantile tracking:
// epsilon += gamma (miss - alpha), within [lo, hi] (after Gibbs and Candes, "Adaptive Conformal
// Inference Under Distribution Shift", 2021). Keeps true: every number is a multiple of `grid`, a
// power of two, and at most 2^24 times `grid`, so sums are exact, and so is the bound on the rate
// of misses.
#pragma once

#include "etlmon/bits.hpp"
#include "etlmon/temporal/truth.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

struct Adaptation {
  float lo;  ///< the threshold stays within [lo, hi]
  float hi;
  float on_miss;  ///< added on a missed positive frame: gamma (1 - alpha), negated for >= and >
  float on_hit;   ///< added on a found one: -gamma alpha, negated for >= and >
  float grid;
};

/// Returns the threshold after a positive frame that was found or missed. An unknown distance (NaN)
/// leaves the threshold unchanged.
ETLMON_INLINE float adapted(float epsilon, Truth found, const Adaptation& by) noexcept {
  if (found.low != found.high) return epsilon;
  const float moved = detail::rounded(epsilon + (found.low ? by.on_hit : by.on_miss));
  return moved < by.lo ? by.lo : moved > by.hi ? by.hi : moved;
}

/// Restores a threshold, for example after a reboot: clamps it to [lo, hi] and rounds it towards 0
/// to a multiple of the grid. Returns `otherwise` if it is NaN, as erased flash memory is.
ETLMON_INLINE float restored(const float& epsilon, float otherwise, const Adaptation& by) noexcept {
  if (is_nan(epsilon)) return otherwise;
  if (key_of(epsilon) <= key_of(by.lo)) return by.lo;
  if (key_of(epsilon) >= key_of(by.hi)) return by.hi;
  return static_cast<float>(static_cast<int32_t>(epsilon / by.grid)) * by.grid;
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
