// SPDX-License-Identifier: MIT
// What a monitor answers after a step.
// Takes: values and keys at the end of a step. Gives: floats and the status that follows from them.
// Keeps true: the status is decided on integer keys, never on floats, so compiler flags cannot
// change it; a Verdict is 16 bytes on every target, trivially copyable, and undecided unless made
// by one of the two functions below.
#pragma once

#include <stdint.h>

#include "etlmon/temporal/value.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

/// What can be asked about one monitor after one step; Self has `status`, of the bits below.
/// Undecided: every question but decided() is moot.
template <class Self>
struct Answers {
  static constexpr uint8_t kSatisfied = 1;
  static constexpr uint8_t kViolated = 2;
  static constexpr uint8_t kDecided = 4;
  static constexpr uint8_t kFinal = 8;

  // What a program acts on.
  /// Violated for good: nothing that may come repairs it.
  constexpr bool alarm() const noexcept { return violated() && final(); }
  /// Satisfied for good: on to the next task.
  constexpr bool fulfilled() const noexcept { return satisfied() && final(); }
  /// What comes may still change the answer.
  constexpr bool open() const noexcept { return decided() && !final(); }

  // What the prefix says, were it to end now. Until it is final, `violated` mostly means "not yet":
  // G F[0,6] p is violated at every step of a good run at which p does not hold.
  constexpr bool satisfied() const noexcept { return has(kSatisfied); }
  constexpr bool violated() const noexcept { return has(kViolated); }
  /// A missing sample leaves it open.
  constexpr bool unknown() const noexcept { return decided() && !satisfied() && !violated(); }
  /// False only before a sliding monitor has seen its horizon.
  constexpr bool decided() const noexcept { return has(kDecided); }
  /// No continuation of the trace changes it between satisfied and violated.
  constexpr bool final() const noexcept { return has(kFinal); }

 private:
  constexpr bool has(uint8_t bit) const noexcept {
    return (static_cast<const Self*>(this)->status & bit) != 0;
  }
};

/// The answers of all monitors with their names, in the order of the spec, for loops over them.
template <class Value, uint32_t count>
struct Named {
  struct Entry {
    const char* name;
    Value verdict;
  };
  Entry entries[count];

  constexpr const Entry* begin() const noexcept { return entries; }
  constexpr const Entry* end() const noexcept { return entries + count; }
};

/// The answer about one monitor after one step. Undecided: the numbers are NaN.
struct Verdict : Answers<Verdict> {
  float robustness = kMissing;  ///< rho; pessimistic where a sample is missing
  float lower = kMissing;       ///< no continuation of the trace takes rho below this
  float upper = kMissing;       ///< nor above this
  uint32_t status = 0;          ///< bits of Answers
};

static_assert(sizeof(Verdict) == 16, "a verdict is three floats and its status");

/// About position 0 of the prefix seen so far. rho: its robustness; lower, upper: its bounds over
/// every continuation.
inline Verdict prefix_verdict(Value rho, Key lower, Key upper) noexcept {
  uint32_t status = Verdict::kDecided;
  if (rho.low >= 0) status += Verdict::kSatisfied;
  if (rho.high < 0) status += Verdict::kViolated;
  if ((~lower | upper) < 0) status += Verdict::kFinal;  // lower >= 0 || upper < 0
  return {{}, float_of(rho.low), float_of(lower), float_of(upper), status};
}

/// About a position whose horizon has been seen: the only doubt left is a missing sample.
inline Verdict sliding_verdict(Value rho) noexcept {
  const uint32_t satisfied = ~static_cast<uint32_t>(rho.low) >> 31;
  const uint32_t violated = static_cast<uint32_t>(rho.high) >> 31;
  const float low = float_of(rho.low);
  return {{},
          low,
          low,
          float_of(rho.high),
          satisfied | violated << 1 | Verdict::kDecided | Verdict::kFinal};
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
