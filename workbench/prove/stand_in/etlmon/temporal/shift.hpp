// SPDX-License-Identifier: MIT
// Stands in for the runtime's shift.hpp when `etlc prove` compiles a class: the number that a
// calibration subtracts from a verdict, after all that is proved, is left out.
#pragma once

#include "etlmon/temporal/reading.hpp"
#include "etlmon/temporal/value.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

inline Value shifted(Value value, const float&) noexcept {
    return value;
}
inline Reading shifted(Reading reading, const float&) noexcept {
    return reading;
}
inline Value shifted(Value value, const float&, const float&) noexcept {
    return value;
}
inline Reading shifted(Reading reading, const float&, const float&) noexcept {
    return reading;
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
