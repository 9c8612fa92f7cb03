// SPDX-License-Identifier: MIT
// Stands in for a part of the runtime's monoid.hpp when `etlc prove` compiles a class: windows ask
// whether both ends of a value are equal. Where the diagrams differ they take the way for values
// that may differ.
#pragma once

#include "etlmon/temporal/value.hpp"

#define same_ends same_numbers
#include_next "etlmon/temporal/monoid.hpp"
#undef same_ends

namespace etlmon {
inline namespace ETLMON_BUILD {

constexpr bool same_ends(Value v) noexcept {
    return v.low.bits == v.high.bits;
}
template <class Value>
constexpr bool same_ends(Span<Value> s) noexcept {
    return same_ends(s.value) && same_ends(s.guard);
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
