// SPDX-License-Identifier: MIT
// `hold N`: the last present sample of an input replaces missing ones. Takes: this step's sample,
// or nothing. Gives: the sample to use, or nothing. Keeps true: at most N missing samples in a row
// are replaced, and none before the first present one.
#pragma once

#include <stdint.h>

#include "etlmon/bits.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

/// Dim elements (float, or uint32_t for a flag), held for at most Steps steps in a row.
template <class Element, uint32_t Dim, uint32_t Steps>
class Hold {
 public:
  constexpr void reset() noexcept { age_ = Steps; }

  /// Returns the sample to use. `sample`: Dim elements, or nullptr if missing. The result is valid
  /// until the next call.
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

  /// Returns the scalar to use; a missing scalar is NaN.
  ETLMON_INLINE float take(const float& sample) noexcept {
    static_assert(Dim == 1, "one number");
    const float* const taken = take(is_nan(sample) ? nullptr : &sample);
    return taken != nullptr ? *taken : detail::from_bits(detail::kMissingBits);
  }

 private:
  Element values_[Dim];
  uint32_t age_;  ///< missing samples since the held one; Steps: none is held
};

}  // namespace ETLMON_BUILD
}  // namespace etlmon
