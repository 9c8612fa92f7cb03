// SPDX-License-Identifier: MIT
// Stands in for the runtime's equality.hpp when `etlc prove` compiles a class, as predicate.hpp
// does for other comparisons.
#pragma once

#include "etlmon/temporal/predicate.hpp"
#include "etlmon/temporal/truth.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

inline Truth is_equal(const float&, const float&, Truth range = kPerhaps) noexcept {
    return range;
}
inline Truth is_unequal(const float&, const float&, Truth range = kPerhaps) noexcept {
    return range;
}
inline Value equal(const float&, const float&, Value) noexcept {
    return etlprove::next_value();
}
inline Value unequal(const float&, const float&, Value) noexcept {
    return etlprove::next_value();
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
