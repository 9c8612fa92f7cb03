// Robustness inside a monitor: ordered integer keys, in pairs.
// Takes: float32 robustness. Gives: values that min and max combine exactly, infinities included, under any compiler
// flags. Keeps true: key order is float order; -0 and +0 share a key; a NaN never becomes a key (predicates turn it
// into a range). A value type V of the temporal operators is any type with min, max (here or found by argument) and a
// Lattice<V>. SPDX-License-Identifier: MIT
#pragma once

#include <stdint.h>
#include <string.h>

namespace etlmon {

/// float32 robustness as an integer whose order is the order of the floats. Comparing integers keeps -ffast-math, which
/// assumes that infinities do not occur, from changing a verdict.
using Key = int32_t;

inline uint32_t bits_of(float x) noexcept {
  uint32_t bits;
  memcpy(&bits, &x, sizeof bits);
  return bits;
}

inline float float_of_bits(uint32_t bits) noexcept {
  float x;
  memcpy(&x, &bits, sizeof x);
  return x;
}

/// The key of a robustness that is not NaN.
inline Key key_of(float robustness) noexcept {
  const uint32_t bits = bits_of(robustness);
  const uint32_t magnitude = bits & 0x7fffffffu;
  return bits == magnitude ? static_cast<Key>(magnitude) : -static_cast<Key>(magnitude);
}

inline float float_of(Key key) noexcept {
  const uint32_t magnitude = static_cast<uint32_t>(key < 0 ? -key : key);
  return float_of_bits(key < 0 ? magnitude | 0x80000000u : magnitude);
}

constexpr Key kTop = 0x7f800000;      ///< +inf: true
constexpr Key kBottom = -0x7f800000;  ///< -inf: false

constexpr Key min(Key a, Key b) noexcept { return b < a ? b : a; }
constexpr Key max(Key a, Key b) noexcept { return a < b ? b : a; }

/// Of floats that are not NaN, compared as keys: exact for infinities and denormals whatever the flags. Of two zeros,
/// a.
inline float min(float a, float b) noexcept { return key_of(b) < key_of(a) ? b : a; }
inline float max(float a, float b) noexcept { return key_of(a) < key_of(b) ? b : a; }

/// What is known of a robustness: low == high where every sample it depends on was there, else the ends of its range.
/// The min-max algebra works on both ends alike, since formulas are in negation normal form (only predicates negate).
struct Value {
  Key low;
  Key high;
};

constexpr Value kTrue{kTop, kTop};
constexpr Value kFalse{kBottom, kBottom};

constexpr Value min(Value a, Value b) noexcept { return {min(a.low, b.low), min(a.high, b.high)}; }
constexpr Value max(Value a, Value b) noexcept { return {max(a.low, b.low), max(a.high, b.high)}; }
constexpr Value negate(Value a) noexcept { return {-a.high, -a.low}; }

/// The value of a robustness that is known; not NaN.
inline Value known(float robustness) noexcept {
  const Key key = key_of(robustness);
  return {key, key};
}

/// The value of a robustness that lies in [low, high]; neither is NaN, low <= high.
inline Value between(float low, float high) noexcept { return {key_of(low), key_of(high)}; }

/// The least and the greatest element of a value type: bottom is false, top is true. A mode (Boolean words, say) is a
/// type with min and max found by argument-dependent lookup and a specialisation of this.
template <class V>
struct Lattice;

template <>
struct Lattice<Key> {
  static constexpr Key bottom() noexcept { return kBottom; }
  static constexpr Key top() noexcept { return kTop; }
};

template <>
struct Lattice<float> {
  static float bottom() noexcept { return float_of(kBottom); }
  static float top() noexcept { return float_of(kTop); }
};

template <>
struct Lattice<Value> {
  static constexpr Value bottom() noexcept { return kFalse; }
  static constexpr Value top() noexcept { return kTrue; }
};

}  // namespace etlmon
