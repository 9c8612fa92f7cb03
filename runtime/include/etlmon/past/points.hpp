// SPDX-License-Identifier: MIT
// `z@N`: samples of earlier steps. Takes: this step's sample after `hold`, or nothing, once a step.
// Gives: the sample of up to N steps ago, or nothing where it was missing or the trace had not
// begun. Keeps true: samples are stored as the input has them; a step costs the same whatever N is;
// what at() returns is valid until the next push().
#pragma once

#include <stdint.h>

#include "etlmon/bits.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

/// Returns the bytes of Earlier<Element, Dim, Steps>.
constexpr uint64_t earlier_bytes(uint64_t element_bytes, uint64_t dim, uint64_t steps) noexcept {
  return 4 + (steps + 31) / 32 * 4 + (element_bytes * dim * steps + 3) / 4 * 4;
}

/// The last Steps samples of Dim elements (float, uint16_t or int8_t).
template <class Element, uint32_t Dim, uint32_t Steps>
class Earlier {
 public:
  constexpr void reset() noexcept {
    next_ = 0;
    for (uint32_t& word : present_) word = 0;
  }

  /// Returns the sample of `ago` steps before the one that is pushed next; 1 to Steps.
  ETLMON_INLINE const Element* at(uint32_t ago) const noexcept {
    const uint32_t slot = next_ >= ago ? next_ - ago : next_ + (Steps - ago);
    return is_present(slot) ? &samples_[static_cast<size_t>(slot) * Dim] : nullptr;
  }

  /// Adds the sample of this step, null if it is missing.
  ETLMON_INLINE void push(const Element* sample) noexcept {
    Element* const slot = &samples_[static_cast<size_t>(next_) * Dim];
    if (sample != nullptr) {
      for (uint32_t i = 0; i < Dim; ++i) slot[i] = sample[i];
    }
    advance(sample != nullptr);
  }

  /// Adds the sample of this step; where it is missing but held, the last one again.
  void push(const Element* sample, bool is_held) noexcept {
    push(sample == nullptr && is_held ? at(1) : sample);
  }

 private:
  bool is_present(uint32_t slot) const noexcept {
    return (present_[slot / 32] >> (slot % 32) & 1u) != 0;
  }
  void advance(bool present) noexcept {
    const uint32_t bit = uint32_t{1} << (next_ % 32);
    uint32_t& word = present_[next_ / 32];
    word = present ? word | bit : word & ~bit;
    next_ = next_ + 1 == Steps ? 0 : next_ + 1;
  }

  uint32_t next_;  ///< slot of the next sample
  uint32_t present_[(Steps + 31) / 32];
  alignas(4) Element samples_[static_cast<size_t>(Steps) * Dim];
};

}  // namespace ETLMON_BUILD
}  // namespace etlmon
