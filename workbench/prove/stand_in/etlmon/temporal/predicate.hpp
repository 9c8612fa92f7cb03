// SPDX-License-Identifier: MIT
// Stands in for a part of the runtime's predicate.hpp when `etlc prove` compiles a class: the
// robustness of a predicate or a bool is the atom whose turn it is in the step.
#pragma once

#define at_most measured_at_most
#define at_least measured_at_least
#define value_of measured_value_of
#include_next "etlmon/temporal/predicate.hpp"
#undef at_most
#undef at_least
#undef value_of

namespace etlprove {

/// Returns the atom whose turn it is.
etlmon::Value next_value();

}  // namespace etlprove

namespace etlmon {
inline namespace ETLMON_BUILD {

/// Measured: a float or an Enclosed; with one threshold or two, and a range.
template <class Measured, class... More>
Value at_most(const Measured&, const float&, const More&...) noexcept {
    return etlprove::next_value();
}
template <class Measured, class... More>
Value at_least(const Measured&, const float&, const More&...) noexcept {
    return etlprove::next_value();
}
inline Value value_of(Flag, Value = {kBottom, kTop}) noexcept {
    return etlprove::next_value();
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
