// SPDX-License-Identifier: MIT
// Thresholds that follow delayed labels, in one number and constant time.
// Takes: the distance of a frame that was in truth positive, as the threshold is now. Gives: the
// threshold from then on, by quantile tracking: epsilon += gamma (miss - alpha), within [lo, hi]
// (after Gibbs and Candes, "Adaptive Conformal Inference Under Distribution Shift", 2021). Keeps
// true: everything is a multiple of `grid`, a power of two, and at most 2^24 of it, so that no sum
// is rounded and the bound on the rate of misses holds to the bit.
#pragma once

#include "etlmon/bits.hpp"
#include "etlmon/temporal/truth.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

struct Adaptation {
  float lo;  ///< the threshold stays within [lo, hi]
  float hi;
  float
      on_miss;   ///< what a missed positive frame adds: gamma (1 - alpha), of >= and > its negative
  float on_hit;  ///< what one that was found adds: -gamma alpha, of >= and > its negative
  float grid;
};

/// The threshold after a positive frame that was found or not. One of unknown distance (NaN) says
/// nothing about the threshold, and leaves it.
ETLMON_INLINE float adapted(float epsilon, Truth found, const Adaptation& by) noexcept {
  if (found.low != found.high) return epsilon;
  const float moved = detail::rounded(epsilon + (found.low ? by.on_hit : by.on_miss));
  return moved < by.lo ? by.lo : moved > by.hi ? by.hi : moved;
}

/// A threshold from elsewhere, such as one that was kept over a reboot: the end of [lo, hi] where
/// it is outside, else the multiple of the grid next to it, towards 0; `otherwise` where it is NaN,
/// as erased flash memory is.
ETLMON_INLINE float restored(const float& epsilon, float otherwise, const Adaptation& by) noexcept {
  if (is_nan(epsilon)) return otherwise;
  if (key_of(epsilon) <= key_of(by.lo)) return by.lo;
  if (key_of(epsilon) >= key_of(by.hi)) return by.hi;
  return static_cast<float>(static_cast<int32_t>(epsilon / by.grid)) * by.grid;
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
