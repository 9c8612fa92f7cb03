// SPDX-License-Identifier: MIT
// Readings: robustness and bounds of a formula at position 0, and their min and max. Takes: the
// values of a monitor. Gives: its verdict. Keeps true: min and max apply to robustness and bounds
// alike, since the bounds of && and || are the min and max of the operands' bounds.
#pragma once

#include "etlmon/temporal/value.hpp"
#include "etlmon/temporal/verdict.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

/// rho on the prefix so far, and its bounds over every continuation. Value: etlmon::Value or Truth.
template <class Value>
struct BasicReading {
  Value rho;
  typename Lattice<Value>::End lower;
  typename Lattice<Value>::End upper;
};
using Reading = BasicReading<Value>;

template <class Value>
constexpr BasicReading<Value> min_of(BasicReading<Value> a, BasicReading<Value> b) noexcept {
  return {min_of(a.rho, b.rho), min_of(a.lower, b.lower), min_of(a.upper, b.upper)};
}

template <class Value>
constexpr BasicReading<Value> max_of(BasicReading<Value> a, BasicReading<Value> b) noexcept {
  return {max_of(a.rho, b.rho), max_of(a.lower, b.lower), max_of(a.upper, b.upper)};
}

/// Returns the reading of a value that no continuation changes.
template <class Value>
constexpr BasicReading<Value> settled(Value rho) noexcept {
  return {rho, rho.low, rho.high};
}

/// Returns the reading of a settled register.
constexpr Reading settled(Register kept) noexcept { return settled<Value>(kept); }

/// Returns a register as a reading.
template <class Value>
constexpr BasicReading<Value> reading_of(Value settled_value) noexcept {
  return settled(settled_value);
}
template <class Value>
constexpr BasicReading<Value> reading_of(BasicReading<Value> reading) noexcept {
  return reading;
}

template <class Value>
struct Lattice<BasicReading<Value>> {
  static constexpr BasicReading<Value> bottom() noexcept {
    return settled(Lattice<Value>::bottom());
  }
  static constexpr BasicReading<Value> top() noexcept { return settled(Lattice<Value>::top()); }
};

template <class Value>
auto prefix_verdict(BasicReading<Value> reading, bool complete = false) noexcept {
  return prefix_verdict(reading.rho, reading.lower, reading.upper, complete);
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
