// SPDX-License-Identifier: MIT
// What a prefix says about a formula at position 0, and how such answers combine.
// Takes: the values that a monitor keeps. Gives: its verdict. Keeps true: min and max act on robustness and bounds
// alike, since the bounds of && and || are the min and max of the operands' bounds.
#pragma once

#include "etlmon/value.hpp"
#include "etlmon/verdict.hpp"

namespace etlmon {

/// rho on the prefix so far, and what every continuation keeps it between.
struct Reading {
  Value rho;
  Key lower;
  Key upper;
};

constexpr Reading min(Reading a, Reading b) noexcept {
  return {min(a.rho, b.rho), min(a.lower, b.lower), min(a.upper, b.upper)};
}

constexpr Reading max(Reading a, Reading b) noexcept {
  return {max(a.rho, b.rho), max(a.lower, b.lower), max(a.upper, b.upper)};
}

/// A reading that no continuation changes.
constexpr Reading settled(Value rho) noexcept { return {rho, rho.low, rho.high}; }

/// A register as a reading.
constexpr Reading reading_of(Value settled_value) noexcept { return settled(settled_value); }
constexpr Reading reading_of(Reading reading) noexcept { return reading; }

inline Verdict prefix_verdict(Reading reading) noexcept {
  return prefix_verdict(reading.rho, reading.lower, reading.upper);
}

}  // namespace etlmon
