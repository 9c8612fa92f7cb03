// SPDX-License-Identifier: MIT
// `hold N`: the last present sample of an input stands in for missing ones.
// Takes: this step's sample, or nothing. Gives: the sample to use, or nothing. Keeps true: at most
// N missing samples in a row are replaced; before the first present one there is nothing to hold.
#pragma once

#include <stdint.h>

#include "etlmon/bits.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

/// D elements of T (float, or uint32_t for a flag), held for at most N steps in a row.
template <class Element, uint32_t Dim, uint32_t Steps>
class Hold {
 public:
  constexpr void reset() noexcept { age_ = Steps; }

  /// `sample`: D elements, or nullptr where it is missing. The result is good until the next call.
  const Element* take(const Element* sample) noexcept {
    if (sample != nullptr) {
      for (uint32_t i = 0; i < Dim; ++i) values_[i] = sample[i];
      age_ = 0;
      return sample;
    }
    if (age_ == Steps) return nullptr;
    ++age_;
    return values_;
  }

  /// The same for a scalar, which is missing where it is NaN.
  ETLMON_INLINE float take(const float& sample) noexcept {
    static_assert(Dim == 1, "one number");
    const float* const taken = take(is_nan(sample) ? nullptr : &sample);
    return taken != nullptr ? *taken : detail::from_bits(detail::kMissingBits);
  }

 private:
  Element values_[Dim];
  uint32_t age_;  ///< missing samples in a row since the held one; N: nothing to hold any more
};

}  // namespace ETLMON_BUILD
}  // namespace etlmon
