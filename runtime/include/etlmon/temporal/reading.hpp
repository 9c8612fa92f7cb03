// SPDX-License-Identifier: MIT
// What a prefix says about a formula at position 0, and how such answers combine.
// Takes: the values that a monitor keeps. Gives: its verdict. Keeps true: min and max act on
// robustness and bounds alike, since the bounds of && and || are the min and max of the operands'
// bounds.
#pragma once

#include "etlmon/temporal/value.hpp"
#include "etlmon/temporal/verdict.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

/// rho on the prefix so far, and what every continuation keeps it between. V: Value or Truth.
template <class V>
struct BasicReading {
  V rho;
  typename Lattice<V>::End lower;
  typename Lattice<V>::End upper;
};
using Reading = BasicReading<Value>;

template <class V>
constexpr BasicReading<V> min_of(BasicReading<V> a, BasicReading<V> b) noexcept {
  return {min_of(a.rho, b.rho), min_of(a.lower, b.lower), min_of(a.upper, b.upper)};
}

template <class V>
constexpr BasicReading<V> max_of(BasicReading<V> a, BasicReading<V> b) noexcept {
  return {max_of(a.rho, b.rho), max_of(a.lower, b.lower), max_of(a.upper, b.upper)};
}

/// A reading that no continuation changes.
template <class V>
constexpr BasicReading<V> settled(V rho) noexcept {
  return {rho, rho.low, rho.high};
}

/// A register that is settled by itself.
constexpr Reading settled(Register kept) noexcept { return settled<Value>(kept); }

/// A register as a reading.
template <class V>
constexpr BasicReading<V> reading_of(V settled_value) noexcept {
  return settled(settled_value);
}
template <class V>
constexpr BasicReading<V> reading_of(BasicReading<V> reading) noexcept {
  return reading;
}

template <class V>
struct Lattice<BasicReading<V>> {
  static constexpr BasicReading<V> bottom() noexcept { return settled(Lattice<V>::bottom()); }
  static constexpr BasicReading<V> top() noexcept { return settled(Lattice<V>::top()); }
};

template <class V>
auto prefix_verdict(BasicReading<V> reading) noexcept {
  return prefix_verdict(reading.rho, reading.lower, reading.upper);
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
