// SPDX-License-Identifier: MIT
// What a monitor answers after a step.
// Takes: values and keys at the end of a step. Gives: floats and the status that follows from them.
// Keeps true: the status is decided on integer keys, never on floats, so compiler flags cannot change it; a Verdict is
// 16 bytes on every target, trivially copyable, and undecided unless made by one of the two functions below.
#pragma once

#include <stdint.h>

#include "etlmon/value.hpp"

namespace etlmon {

/// The answer about one monitor after one step. Undecided: the numbers are NaN and every question but decided() is
/// moot.
struct Verdict {
  static constexpr uint32_t kSatisfied = 1;
  static constexpr uint32_t kViolated = 2;
  static constexpr uint32_t kDecided = 4;
  static constexpr uint32_t kFinal = 8;

  float robustness = kMissing;  ///< rho; pessimistic where a sample is missing
  float lower = kMissing;       ///< no continuation of the trace takes rho below this
  float upper = kMissing;       ///< nor above this
  uint32_t status = 0;          ///< the bits above

  constexpr bool satisfied() const noexcept { return (status & kSatisfied) != 0; }
  constexpr bool violated() const noexcept { return (status & kViolated) != 0; }
  /// A missing sample leaves it open.
  constexpr bool unknown() const noexcept { return (status & (kSatisfied | kViolated | kDecided)) == kDecided; }
  /// False only before a sliding monitor has seen its horizon.
  constexpr bool decided() const noexcept { return (status & kDecided) != 0; }
  /// No continuation of the trace changes it between satisfied and violated.
  constexpr bool final() const noexcept { return (status & kFinal) != 0; }
};

static_assert(sizeof(Verdict) == 16, "a verdict is three floats and its status");

/// About position 0 of the prefix seen so far. rho: its robustness; lower, upper: its bounds over every continuation.
inline Verdict prefix_verdict(Value rho, Key lower, Key upper) noexcept {
  const uint32_t satisfied = ~static_cast<uint32_t>(rho.low) >> 31;  // signs of keys: rho.low >= 0
  const uint32_t violated = static_cast<uint32_t>(rho.high) >> 31;   // rho.high < 0
  const uint32_t settled = (~static_cast<uint32_t>(lower) | static_cast<uint32_t>(upper)) >> 31;
  return {float_of(rho.low), float_of(lower), float_of(upper),
          satisfied | violated << 1 | Verdict::kDecided | settled << 3};
}

/// About a position whose horizon has been seen: the only doubt left is a missing sample.
inline Verdict sliding_verdict(Value rho) noexcept {
  const uint32_t satisfied = ~static_cast<uint32_t>(rho.low) >> 31;
  const uint32_t violated = static_cast<uint32_t>(rho.high) >> 31;
  const float low = float_of(rho.low);
  return {low, low, float_of(rho.high), satisfied | violated << 1 | Verdict::kDecided | Verdict::kFinal};
}

}  // namespace etlmon
