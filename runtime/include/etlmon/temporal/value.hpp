// SPDX-License-Identifier: MIT
// Robustness inside a monitor: ordered integer keys, in pairs.
// Takes: float32 robustness. Gives: values that min and max combine exactly, infinities included,
// under any compiler flags. Keeps true: key order is float order; -0 and +0 share a key; a NaN
// never becomes a key (predicates turn it into a range). A value type V of the temporal operators
// is any type with min_of, max_of (here or found by argument; min and max are macros of windows.h)
// and a Lattice<V>.
#pragma once

#include <stdint.h>

#include "etlmon/bits.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

/// float32 robustness as an integer whose order is the order of the floats. Comparing integers
/// keeps -ffast-math, which assumes that infinities do not occur, from changing a verdict.
using Key = int32_t;

ETLMON_INLINE uint32_t bits_of(const float& x) noexcept { return detail::observe(x); }

ETLMON_INLINE float float_of_bits(uint32_t bits) noexcept { return detail::from_bits(bits); }

/// The key of a robustness that is not NaN.
ETLMON_INLINE Key key_of(const float& robustness) noexcept {
  return detail::ordered(bits_of(robustness));
}

/// The float of a key; 0 is +0. The order's own inverse is the order.
ETLMON_INLINE float float_of(Key key) noexcept {
  return float_of_bits(static_cast<uint32_t>(detail::ordered(static_cast<uint32_t>(key))));
}

constexpr Key kTop = 0x7f800000;      ///< +inf: true
constexpr Key kBottom = -0x7f800000;  ///< -inf: false

constexpr Key min_of(Key a, Key b) noexcept { return b < a ? b : a; }
constexpr Key max_of(Key a, Key b) noexcept { return a < b ? b : a; }

/// Of truth values: "and" and "or".
constexpr bool min_of(bool a, bool b) noexcept { return a && b; }
constexpr bool max_of(bool a, bool b) noexcept { return a || b; }

/// Of floats that are not NaN, compared as keys: exact for infinities and denormals whatever the
/// flags. Of two zeros, a.
ETLMON_INLINE float min_of(float a, float b) noexcept { return key_of(b) < key_of(a) ? b : a; }
ETLMON_INLINE float max_of(float a, float b) noexcept { return key_of(a) < key_of(b) ? b : a; }

/// What is known of a robustness: low == high where every sample it depends on was there, else the
/// ends of its range. The min-max algebra works on both ends alike, since formulas are in negation
/// normal form (only predicates negate).
struct Value {
  Key low;
  Key high;
};

constexpr Value kTrue{kTop, kTop};
constexpr Value kFalse{kBottom, kBottom};

constexpr Value min_of(Value a, Value b) noexcept {
  return {min_of(a.low, b.low), min_of(a.high, b.high)};
}
constexpr Value max_of(Value a, Value b) noexcept {
  return {max_of(a.low, b.low), max_of(a.high, b.high)};
}
constexpr Value negate(Value a) noexcept { return {-a.high, -a.low}; }

/// A value that a monitor keeps from step to step. Its ends are of two types: of one, g++ makes a
/// vector of what two registers are assigned and stores that, and the next step, which reads them
/// one by one, waits for the vector.
struct Register {
  struct End {
    uint32_t bits;
    constexpr operator Key() const noexcept { return static_cast<Key>(bits); }
  };
  Key low;
  End high;

  constexpr operator Value() const noexcept { return {low, high}; }
  ETLMON_INLINE constexpr Register& operator=(Value value) noexcept {
    low = value.low;
    high.bits = static_cast<uint32_t>(value.high);
    return *this;
  }
};

/// The value of a robustness that lies in [low, high]; neither is NaN, low <= high.
ETLMON_INLINE Value between(const float& low, const float& high) noexcept {
  return {key_of(low), key_of(high)};
}

/// Of more than two: values and registers, or all of another type.
template <class First, class Second, class Third, class... More>
constexpr auto min_of(First a, Second b, Third c, More... more) noexcept {
  return min_of(min_of(a, b), c, more...);
}
template <class First, class Second, class Third, class... More>
constexpr auto max_of(First a, Second b, Third c, More... more) noexcept {
  return max_of(max_of(a, b), c, more...);
}

/// The least and the greatest element of a value type: bottom is false, top is true; End is the
/// type of its two ends, low and high. A mode (truth.hpp, say) is a type with min_of and max_of
/// found by argument-dependent lookup and a specialisation of this.
template <class Value>
struct Lattice;

template <>
struct Lattice<Key> {
  using End = Key;
  static constexpr Key bottom() noexcept { return kBottom; }
  static constexpr Key top() noexcept { return kTop; }
};

template <>
struct Lattice<Value> {
  using End = Key;
  static constexpr Value bottom() noexcept { return kFalse; }
  static constexpr Value top() noexcept { return kTrue; }
};

}  // namespace ETLMON_BUILD
}  // namespace etlmon
