// SPDX-License-Identifier: MIT
// Adds to the runtime's pending.hpp when `etlc prove` compiles a class: a formula at position 0,
// with the number of the step as a counter that is alike from some step on.
#pragma once

#include_next "etlmon/temporal/pending.hpp"

#include "etlprove/uses.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

/// From the step on at which all positions that are read are past `high`, or past `low` if nothing
/// is too late, and the operands are settled, the step does not count.
template <class Sense, class Value>
BasicReading<Value> pending_from_start(Value& best, Value& held,
                                       const typename detail::As<BasicReading<Value>>::Type* f,
                                       const BasicReading<Value>* g, uint32_t n,
                                       const etlprove::Counter& step, uint32_t horizon,
                                       uint32_t low, uint32_t high,
                                       typename Lattice<Value>::End unseen) noexcept {
    const uint64_t last = high == kWithoutEnd ? low : uint64_t{high} + 1;
    const uint64_t alike = last + n > horizon ? last + n : horizon;
    return pending_from_start<Sense, Value>(
        best, held, f, g, n, static_cast<uint32_t>(step.up_to(alike)), horizon, low, high, unseen);
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
