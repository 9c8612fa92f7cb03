// SPDX-License-Identifier: MIT
// The verdict of a monitor after a step. Takes: values and keys at the end of a step. Gives: floats
// and a status. Keeps true: the status is decided on integer keys, so compiler flags cannot change
// it; a Verdict is 16 bytes on every target, trivially copyable, and undecided unless made by one
// of the two functions below.
#pragma once

#include <stdint.h>

#include "etlmon/temporal/value.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

/// The questions about a verdict; Self has `status`, made of the bits below. An undecided verdict
/// answers only decided().
template <class Self>
struct Answers {
  static constexpr uint8_t kSatisfied = 1;
  static constexpr uint8_t kViolated = 2;
  static constexpr uint8_t kDecided = 4;
  static constexpr uint8_t kFinal = 8;

  // A program acts on these.
  /// Violated for good, whatever comes.
  constexpr bool alarm() const noexcept { return violated() && final(); }
  /// Satisfied for good, whatever comes.
  constexpr bool fulfilled() const noexcept { return satisfied() && final(); }
  /// Later steps may still change the answer.
  constexpr bool open() const noexcept { return decided() && !final(); }

  // These judge the prefix as if the trace ended now. Until the verdict is final, `violated` often
  // means "not yet": G F[0,6] p is violated at every step at which p does not hold.
  constexpr bool satisfied() const noexcept { return has(kSatisfied); }
  constexpr bool violated() const noexcept { return has(kViolated); }
  /// Undetermined, by a missing sample or a number between two thresholds.
  constexpr bool unknown() const noexcept { return decided() && !satisfied() && !violated(); }
  /// False only before a sliding monitor has seen its horizon.
  constexpr bool decided() const noexcept { return has(kDecided); }
  /// No continuation of the trace changes it. That of a sliding or repeating monitor may be unknown
  /// for good, where the formula looks no further ahead.
  constexpr bool final() const noexcept { return has(kFinal); }

 private:
  constexpr bool has(uint8_t bit) const noexcept {
    return (static_cast<const Self*>(this)->status & bit) != 0;
  }
};

/// The verdicts of all monitors with their names, in the order of the spec, for loops.
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

/// The verdict of a monitor after a step. If it is undecided, the numbers are NaN.
struct Verdict : Answers<Verdict> {
  float robustness = kMissing;  ///< rho; the lowest possible if a sample is missing or between two
                                ///< thresholds
  float lower = kMissing;       ///< lower bound of rho over every continuation
  float upper = kMissing;       ///< upper bound of rho over every continuation
  uint32_t status = 0;          ///< bits of Answers
};

static_assert(sizeof(Verdict) == 16, "a verdict is three floats and its status");

/// Returns the verdict about position 0 of the prefix. rho: its robustness; lower, upper: its
/// bounds over every continuation; complete: the prefix has all that the formula looks ahead.
inline Verdict prefix_verdict(Value rho, Key lower, Key upper, bool complete = false) noexcept {
  uint32_t status = Verdict::kDecided;
  if (rho.low >= 0) status += Verdict::kSatisfied;
  if (rho.high < 0) status += Verdict::kViolated;
  if (complete || (~lower | upper) < 0) status += Verdict::kFinal;  // lower >= 0 || upper < 0
  return {{}, float_of(rho.low), float_of(lower), float_of(upper), status};
}

/// Returns the verdict about a position whose horizon is complete.
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
