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

/// A reading that no continuation changes.
template <class Value>
constexpr BasicReading<Value> settled(Value rho) noexcept {
  return {rho, rho.low, rho.high};
}

/// A register that is settled by itself.
constexpr Reading settled(Register kept) noexcept { return settled<Value>(kept); }

/// A register as a reading.
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
auto prefix_verdict(BasicReading<Value> reading) noexcept {
  return prefix_verdict(reading.rho, reading.lower, reading.upper);
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
