// SPDX-License-Identifier: MIT
// Robustness in a monitor: pairs of ordered integer keys. Takes: float32 robustness. Gives: values
// that min and max combine exactly, infinities included, under any compiler flags. Keeps true: key
// order is float order; -0 and +0 share a key; a NaN never becomes a key (predicates turn it into a
// range). A value type of the temporal operators is any type with min_of, max_of (here or by
// argument-dependent lookup; min and max are macros of windows.h) and a Lattice.
#pragma once

#include <stdint.h>

#include "etlmon/bits.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

/// float32 robustness as an integer in the order of the floats. Comparisons of integers are not
/// affected by -ffast-math, which assumes that infinities do not occur.
using Key = int32_t;

ETLMON_INLINE uint32_t bits_of(const float& x) noexcept { return detail::observe(x); }

ETLMON_INLINE float float_of_bits(uint32_t bits) noexcept { return detail::from_bits(bits); }

/// Returns the key of a robustness, which is not NaN.
ETLMON_INLINE Key key_of(const float& robustness) noexcept {
  return detail::ordered(bits_of(robustness));
}

/// Returns the float of a key; 0 is +0. ordered() is its own inverse.
ETLMON_INLINE float float_of(Key key) noexcept {
  return float_of_bits(static_cast<uint32_t>(detail::ordered(static_cast<uint32_t>(key))));
}

constexpr Key kTop = 0x7f800000;      ///< +inf: true
constexpr Key kBottom = -0x7f800000;  ///< -inf: false

constexpr Key min_of(Key a, Key b) noexcept { return b < a ? b : a; }
constexpr Key max_of(Key a, Key b) noexcept { return a < b ? b : a; }

/// "And" and "or" of truth values.
constexpr bool min_of(bool a, bool b) noexcept { return a && b; }
constexpr bool max_of(bool a, bool b) noexcept { return a || b; }

/// Min and max of floats that are not NaN. They are compared as keys, which is exact for infinities
/// and denormals under any flags. Of two zeros, returns a.
ETLMON_INLINE float min_of(float a, float b) noexcept { return key_of(b) < key_of(a) ? b : a; }
ETLMON_INLINE float max_of(float a, float b) noexcept { return key_of(a) < key_of(b) ? b : a; }

/// The range of a robustness: low == high unless a sample that it depends on is missing, or between
/// two thresholds. Min and max apply to both ends alike, since formulas are in negation normal form
/// (only predicates negate).
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

/// A value kept between steps. Its ends have two types: with one type, g++ stores two registers as
/// a vector, and the next step, which reads them one by one, waits for that store.
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

/// Returns the value of a robustness in [low, high]; neither is NaN, low <= high.
ETLMON_INLINE Value between(const float& low, const float& high) noexcept {
  return {key_of(low), key_of(high)};
}

/// Min and max of more than two: values and registers, or all of another type.
template <class First, class Second, class Third, class... More>
constexpr auto min_of(First a, Second b, Third c, More... more) noexcept {
  return min_of(min_of(a, b), c, more...);
}
template <class First, class Second, class Third, class... More>
constexpr auto max_of(First a, Second b, Third c, More... more) noexcept {
  return max_of(max_of(a, b), c, more...);
}

/// The least element (false) and the greatest (true) of a value type, and End, the type of its ends
/// low and high.
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
