// SPDX-License-Identifier: MIT
// `stale after N`: a sample that repeats too often counts as missing. Takes: the samples of an
// input that are present, in order. Gives: whether to use each. Keeps true: of equal samples in a
// row the first N are used and no others, whatever is missing between them; two samples are equal
// if their bits are, so +0 and -0 differ.
#pragma once

#include <stdint.h>

#include "etlmon/bits.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

namespace detail {

ETLMON_INLINE uint32_t difference(const float& a, const float& b) noexcept {
  return observe(a) ^ observe(b);
}
ETLMON_INLINE uint32_t difference(uint16_t a, uint16_t b) noexcept { return a == b ? 0 : 1; }
ETLMON_INLINE uint32_t difference(int8_t a, int8_t b) noexcept { return a == b ? 0 : 1; }

}  // namespace detail

/// Dim elements as the input stores them (float, uint16_t or int8_t), used at most Most times in a
/// row.
template <class Element, uint32_t Dim, uint32_t Most>
class StaleAfter {
 public:
  static_assert(Most > 0, "the first of equal samples is never stale");

  constexpr void reset() noexcept { repeats_ = 0; }

  /// Returns whether to use the sample. `sample`: Dim elements. A missing sample is not passed, and
  /// changes nothing.
  bool accepts(const Element* sample) noexcept {
    uint32_t differs = 0;
    for (uint32_t i = 0; i < Dim; ++i) {
      differs |= detail::difference(values_[i], sample[i]);
      values_[i] = sample[i];
    }
    if (differs != 0 || repeats_ == 0) {
      repeats_ = 1;
      return true;
    }
    if (repeats_ == Most) return false;
    ++repeats_;
    return true;
  }

  /// Returns the scalar, or NaN if it is missing or not to be used.
  ETLMON_INLINE float accept(const float& sample) noexcept {
    static_assert(Dim == 1, "one number");
    const bool used = !is_nan(sample) && accepts(&sample);
    return detail::from_bits(used ? detail::observe(sample) : detail::kMissingBits);
  }

 private:
  Element values_[Dim];
  uint32_t repeats_;  ///< times that the last sample was used in a row; 0: there is none
};

}  // namespace ETLMON_BUILD
}  // namespace etlmon
