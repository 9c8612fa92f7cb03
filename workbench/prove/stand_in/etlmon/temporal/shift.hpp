// SPDX-License-Identifier: MIT
// Stands in for the runtime's shift.hpp when `etlc prove` compiles a class: the number that a
// calibration subtracts from a verdict, after all that is proved, is left out.
#pragma once

#include "etlmon/temporal/reading.hpp"
#include "etlmon/temporal/value.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

template <class Of, class... Shifts>
Of shifted(Of value, const Shifts&...) noexcept {
    return value;
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
