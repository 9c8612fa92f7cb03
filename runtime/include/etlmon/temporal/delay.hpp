// SPDX-License-Identifier: MIT
// A stream, delayed by a fixed number of steps. Takes: one value a step. Gives: the value of N
// steps ago; the fill for the first N steps. Keeps true: one read and one write a step, whatever N;
// state is N values and a cursor, the same on every target.
#pragma once

#include <stdint.h>

#include "etlmon/bits.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

/// One step of a delay by n >= 1 over caller-owned storage of n values, all set to the fill at
/// first; cursor starts at 0.
template <class Value>
ETLMON_STEP Value delay_push(Value* storage, uint32_t& cursor, uint32_t n, Value value) noexcept {
  const uint32_t at =
      cursor;  // read once: for all that a compiler knows, the storage might hold the cursor
  cursor = at + 1 == n ? 0 : at + 1;
  const Value past = storage[at];
  storage[at] = value;
  return past;
}

/// Delays by N >= 1 steps. V: trivially copyable, alignment at most 4.
template <class Value, uint32_t Length>
class Delay {
  static_assert(Length >= 1, "a delay by nothing is the value itself");
  static_assert(alignof(Value) <= alignof(uint32_t),
                "the cursor comes first, so that no padding follows it");

 public:
  /// Forgets all; the next N pushes give `fill`.
  constexpr void reset(Value fill) noexcept {
    cursor_ = 0;
    for (uint32_t i = 0; i < Length; ++i) values_[i] = fill;
  }

  /// Takes this step's value, gives that of N pushes ago.
  ETLMON_STEP Value push(Value value) noexcept {
    return delay_push(values_, cursor_, Length, value);
  }

 private:
  uint32_t cursor_;
  Value values_[Length];
};

}  // namespace ETLMON_BUILD
}  // namespace etlmon
