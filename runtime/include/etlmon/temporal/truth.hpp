// SPDX-License-Identifier: MIT
// Truth values in a Boolean monitor: two bits for what is known. Takes: comparisons. Gives: a value
// type for the temporal operators and machines: min is "and", max is "or". Keeps true: low implies
// high; they differ only if a sample is missing, or between two thresholds.
#pragma once

#include "etlmon/bits.hpp"
#include "etlmon/scalars.hpp"
#include "etlmon/temporal/value.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

struct Truth {
  bool low : 1;   ///< surely true
  bool high : 1;  ///< possibly true
};
static_assert(sizeof(Truth) == 1, "two bits in a byte");

constexpr Truth kYes{true, true};
constexpr Truth kNo{false, false};
constexpr Truth kPerhaps{false, true};  ///< a sample is missing, or between two thresholds

constexpr Truth min_of(Truth a, Truth b) noexcept { return {a.low && b.low, a.high && b.high}; }
constexpr Truth max_of(Truth a, Truth b) noexcept { return {a.low || b.low, a.high || b.high}; }
constexpr Truth negate(Truth a) noexcept { return {!a.high, !a.low}; }

template <>
struct Lattice<bool> {
  using End = bool;
  static constexpr bool bottom() noexcept { return false; }
  static constexpr bool top() noexcept { return true; }
};

template <>
struct Lattice<Truth> {
  using End = bool;
  static constexpr Truth bottom() noexcept { return kNo; }
  static constexpr Truth top() noexcept { return kYes; }
};

constexpr Truth truth_of(bool yes) noexcept { return yes ? kYes : kNo; }
constexpr Truth truth_of(Flag flag, Truth missing = kPerhaps) noexcept {
  return flag.present() ? truth_of(flag.value()) : missing;
}

/// Compares keys, which is exact under any compiler flags. Returns `range` if delta is NaN.
ETLMON_INLINE Truth is_at_most(const float& delta, const float& epsilon,
                               Truth range = kPerhaps) noexcept {
  return is_nan(delta) ? range : truth_of(key_of(delta) <= key_of(epsilon));
}
ETLMON_INLINE Truth is_below(const float& delta, const float& epsilon,
                             Truth range = kPerhaps) noexcept {
  return is_nan(delta) ? range : truth_of(key_of(delta) < key_of(epsilon));
}
ETLMON_INLINE Truth is_at_least(const float& delta, const float& epsilon,
                                Truth range = kPerhaps) noexcept {
  return is_nan(delta) ? range : truth_of(key_of(delta) >= key_of(epsilon));
}
ETLMON_INLINE Truth is_above(const float& delta, const float& epsilon,
                             Truth range = kPerhaps) noexcept {
  return is_nan(delta) ? range : truth_of(key_of(delta) > key_of(epsilon));
}

// Of two thresholds: true within `inner`, false beyond `outer`. Nothing is within or beyond one
// that is infinite.
ETLMON_INLINE Truth is_at_most(const float& delta, const float& inner, const float& outer,
                               Truth range = kPerhaps) noexcept {
  if (is_nan(delta)) return range;
  return {is_finite(inner) && key_of(delta) <= key_of(inner),
          !is_finite(outer) || key_of(delta) <= key_of(outer)};
}
ETLMON_INLINE Truth is_below(const float& delta, const float& inner, const float& outer,
                             Truth range = kPerhaps) noexcept {
  if (is_nan(delta)) return range;
  return {is_finite(inner) && key_of(delta) < key_of(inner),
          !is_finite(outer) || key_of(delta) < key_of(outer)};
}
ETLMON_INLINE Truth is_at_least(const float& delta, const float& inner, const float& outer,
                                Truth range = kPerhaps) noexcept {
  if (is_nan(delta)) return range;
  return {is_finite(inner) && key_of(delta) >= key_of(inner),
          !is_finite(outer) || key_of(delta) >= key_of(outer)};
}
ETLMON_INLINE Truth is_above(const float& delta, const float& inner, const float& outer,
                             Truth range = kPerhaps) noexcept {
  if (is_nan(delta)) return range;
  return {is_finite(inner) && key_of(delta) > key_of(inner),
          !is_finite(outer) || key_of(delta) > key_of(outer)};
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
