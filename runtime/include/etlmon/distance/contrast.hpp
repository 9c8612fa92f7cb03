// SPDX-License-Identifier: MIT
// The difference of two distances with bounds. Takes: two intervals of enclosed.hpp. Gives: the
// interval of the difference in float32. Keeps true: rounding is monotonic, so the ends are the
// least and the greatest number that any build computes; if a distance is unknown, so is the
// difference.
#pragma once

#include "etlmon/distance/enclosed.hpp"
#include "etlmon/temporal/expression.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

ETLMON_INLINE Enclosed difference(const Enclosed& a, const Enclosed& b) noexcept {
  Enclosed result;
  result.measured.delta = subtract(a.measured.delta, b.measured.delta);
  result.low = subtract(a.low, b.high);
  result.high = subtract(a.high, b.low);
  return result;
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
