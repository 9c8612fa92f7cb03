// SPDX-License-Identifier: MIT
// The verdict of a Boolean monitor after a step. Takes: truth values at the end of a step. Gives:
// the status of a verdict. Keeps true: a BooleanVerdict is one byte on every target, and undecided
// unless made by one of the two functions below.
#pragma once

#include <stdint.h>

#include "etlmon/temporal/truth.hpp"
#include "etlmon/temporal/verdict.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

/// The verdict of a Boolean monitor: the questions of Verdict, without numbers.
struct BooleanVerdict : Answers<BooleanVerdict> {
  uint8_t status = 0;  ///< bits of Answers
};

static_assert(sizeof(BooleanVerdict) == 1, "a Boolean verdict is its status");

inline BooleanVerdict prefix_verdict(Truth holds, bool surely, bool perhaps,
                                     bool complete = false) noexcept {
  const unsigned satisfied = holds.low ? BooleanVerdict::kSatisfied : 0u;
  const unsigned violated = holds.high ? 0u : BooleanVerdict::kViolated;
  const unsigned settled = surely || !perhaps || complete ? BooleanVerdict::kFinal : 0u;
  return {{}, static_cast<uint8_t>(satisfied | violated | settled | BooleanVerdict::kDecided)};
}

inline BooleanVerdict sliding_verdict(Truth holds) noexcept {
  return prefix_verdict(holds, true, true);
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
