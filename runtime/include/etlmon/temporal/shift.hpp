// SPDX-License-Identifier: MIT
// Robustness shifted by the calibration of a whole monitor. Takes: keys, and a finite shift. Gives:
// the key of rho - shift. Keeps true: one float32 subtraction, which is monotonic, so bounds stay
// bounds; true and false, which are infinite, do not change.
#pragma once

#include "etlmon/temporal/reading.hpp"
#include "etlmon/temporal/value.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

ETLMON_INLINE Key shifted(Key key, const float& shift) noexcept {
  if (key == kTop || key == kBottom) return key;
  return key_of(detail::rounded(float_of(key) - shift));
}

ETLMON_INLINE Value shifted(Value value, const float& shift) noexcept {
  return {shifted(value.low, shift), shifted(value.high, shift)};
}

ETLMON_INLINE Reading shifted(Reading reading, const float& shift) noexcept {
  return {shifted(reading.rho, shift), shifted(reading.lower, shift),
          shifted(reading.upper, shift)};
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
