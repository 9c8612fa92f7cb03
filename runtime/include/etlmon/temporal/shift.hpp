// SPDX-License-Identifier: MIT
// Robustness shifted by the calibration of a whole monitor. Takes: keys, and a finite shift, or two
// shifts. Gives: the key of rho - shift. Keeps true: one float32 subtraction, which is monotonic,
// so bounds stay bounds; true and false, which are infinite, do not change, unless a shift is
// infinite.
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

// Two shifts: `least`, at which a verdict is satisfied, of the low ends, and `most`, below which it
// is violated, of the high ones. By an infinite one it never is.
namespace detail {
ETLMON_INLINE Key shifted_end(Key key, const float& shift) noexcept {
  return is_finite(shift) ? etlmon::shifted(key, shift) : -key_of(shift);
}
}  // namespace detail

ETLMON_INLINE Value shifted(Value value, const float& least, const float& most) noexcept {
  return {detail::shifted_end(value.low, least), detail::shifted_end(value.high, most)};
}

ETLMON_INLINE Reading shifted(Reading reading, const float& least, const float& most) noexcept {
  return {shifted(reading.rho, least, most), detail::shifted_end(reading.lower, least),
          detail::shifted_end(reading.upper, most)};
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
