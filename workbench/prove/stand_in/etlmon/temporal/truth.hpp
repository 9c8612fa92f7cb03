// SPDX-License-Identifier: MIT
// Stands in for the runtime's truth.hpp when `etlc prove` compiles a class: both ends of a truth
// are functions of the samples, as diagrams. Takes: what the runtime's file takes. Gives: the same
// names.
#pragma once

#include "etlmon/scalars.hpp"
#include "etlmon/temporal/value.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

using Bit = etlprove::Bit;

struct Truth {
    Bit low;
    Bit high;
};

constexpr Truth kYes{true, true};
constexpr Truth kNo{false, false};
constexpr Truth kPerhaps{false, true};

inline Truth min_of(Truth a, Truth b) noexcept {
    return {a.low && b.low, a.high && b.high};
}
inline Truth max_of(Truth a, Truth b) noexcept {
    return {a.low || b.low, a.high || b.high};
}
inline Truth negate(Truth a) noexcept {
    return {!a.high, !a.low};
}

template <>
struct Lattice<Bit> {
    using End = Bit;
    static constexpr Bit bottom() noexcept { return false; }
    static constexpr Bit top() noexcept { return true; }
};

template <>
struct Lattice<Truth> {
    using End = Bit;
    static constexpr Truth bottom() noexcept { return kNo; }
    static constexpr Truth top() noexcept { return kYes; }
};

inline Truth truth_of(Bit yes) noexcept {
    return {yes, yes};
}
inline Truth truth_of(Flag flag, Truth missing = kPerhaps) noexcept {
    return flag.present() ? truth_of(Bit(flag.value())) : missing;
}

// Only what an atom measures, which does not run: of one threshold or two, and of a range.
template <class... More>
Truth is_at_most(const float&, const float&, const More&...) noexcept {
    return kPerhaps;
}
template <class... More>
Truth is_below(const float&, const float&, const More&...) noexcept {
    return kPerhaps;
}
template <class... More>
Truth is_at_least(const float&, const float&, const More&...) noexcept {
    return kPerhaps;
}
template <class... More>
Truth is_above(const float&, const float&, const More&...) noexcept {
    return kPerhaps;
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
