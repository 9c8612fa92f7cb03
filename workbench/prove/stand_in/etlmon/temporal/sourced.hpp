// SPDX-License-Identifier: MIT
// Stands in for the runtime's sourced.hpp when `etlc prove` compiles a class with --explain. Takes:
// values with the rank of their sample, which are ordered by both. Gives: the same names.
// Keeps true: min, max and negation choose among such pairs as among numbers, so one diagram proves
// both the robustness and the sample.
#pragma once

#include <stdint.h>

#include "etlmon/temporal/handover.hpp"
#include "etlmon/temporal/shift.hpp"
#include "etlmon/temporal/verdict.hpp"
#include "etlmon/temporal/window.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

using Rank = uint32_t;

struct SourcedKey {
    Key of;
    uint32_t rank;

    SourcedKey() noexcept = default;
    constexpr SourcedKey(Key key) noexcept : of(key), rank(0) {}
};

struct Sourced {
    SourcedKey low;
    SourcedKey high;

    Sourced() noexcept = default;
    constexpr Sourced(SourcedKey low_end, SourcedKey high_end) noexcept
        : low(low_end), high(high_end) {}
    constexpr Sourced(Value value) noexcept : low(value.low), high(value.high) {}
};

constexpr Sourced kTrueItself{kTrue};
constexpr Sourced kFalseItself{kFalse};

inline SourcedKey min_of(SourcedKey a, SourcedKey b) noexcept {
    return min_of(a.of, b.of);
}
inline SourcedKey max_of(SourcedKey a, SourcedKey b) noexcept {
    return max_of(a.of, b.of);
}
inline Sourced min_of(Sourced a, Sourced b) noexcept {
    return {min_of(a.low, b.low), min_of(a.high, b.high)};
}
inline Sourced max_of(Sourced a, Sourced b) noexcept {
    return {max_of(a.low, b.low), max_of(a.high, b.high)};
}
inline SourcedKey negate(SourcedKey a) noexcept {
    return -a.of;
}
inline Sourced negate(Sourced a) noexcept {
    return {negate(a.high), negate(a.low)};
}

struct SourcedRegister {
    struct End {
        Key of;
        uint32_t rank;
        End() noexcept = default;
        constexpr End(Key key) noexcept : of(key), rank(0) {}
        constexpr operator SourcedKey() const noexcept { return SourcedKey(of); }
    };
    SourcedKey low;
    End high;

    constexpr operator Sourced() const noexcept { return {low, high}; }
    constexpr SourcedRegister& operator=(Sourced value) noexcept {
        low = value.low;
        high = End(value.high.of);
        return *this;
    }
};

template <>
struct Lattice<SourcedKey> {
    using End = SourcedKey;
    static constexpr SourcedKey bottom() noexcept { return kBottom; }
    static constexpr SourcedKey top() noexcept { return kTop; }
};
template <>
struct Lattice<Sourced> {
    using End = SourcedKey;
    static constexpr Sourced bottom() noexcept { return kFalseItself; }
    static constexpr Sourced top() noexcept { return kTrueItself; }
};

constexpr BasicReading<Sourced> settled(SourcedRegister kept) noexcept {
    return settled<Sourced>(kept);
}

constexpr SourcedKey low_of(Sourced v) noexcept {
    return v.low;
}
constexpr SourcedKey high_of(Sourced v) noexcept {
    return v.high;
}
constexpr Sourced pair_of(SourcedKey low, SourcedKey high) noexcept {
    return {low, high};
}
constexpr bool same_ends(Sourced v) noexcept {
    return v.low.of.bits == v.high.of.bits;
}

template <template <class> class Operator, uint32_t Length>
class Window<Operator<Sourced>, Length> : public PairWindow<Operator, Sourced, Length> {};

/// Only measure() gives samples their rank.
inline Sourced sourced(Value value, Rank) noexcept {
    return value;
}

template <uint32_t count>
struct Ranks {
    static Rank first(uint32_t) noexcept { return 0; }
};

inline Value unsourced(Sourced value) noexcept {
    return {value.low.of, value.high.of};
}
inline Reading unsourced(BasicReading<Sourced> reading) noexcept {
    return {unsourced(reading.rho), reading.lower.of, reading.upper.of};
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
