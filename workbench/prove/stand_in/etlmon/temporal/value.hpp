// SPDX-License-Identifier: MIT
// Stands in for the runtime's value.hpp when `etlc prove` compiles a class: a robustness is a
// function of the samples, as a diagram. Takes: what the runtime's file takes. Gives: the same
// names. Keeps true: min, max and negation are those of diagrams; a comparison of two
// values, which the class would branch on, ends the proof.
#pragma once

#include <math.h>
#include <stdint.h>

#include "etlmon/bits.hpp"
#include "etlprove/space.hpp"

namespace etlprove {

inline Numbers& numbers() {
    static Numbers kept(diagrams(), {});
    return kept;
}
[[noreturn]] void ask_for(float number);

}  // namespace etlprove

namespace etlmon {
inline namespace ETLMON_BUILD {

/// One end of a robustness.
struct Key {
    uint32_t bits;

    Key() noexcept = default;
    /// Numbers of earlier steps are keys too; those in measure() have no diagram.
    constexpr Key(int32_t) noexcept : bits(0) {}
    static constexpr Key with_bits(uint32_t bits) noexcept {
        Key key(0);
        key.bits = bits;
        return key;
    }
    static Key of(etlprove::Diagram diagram) noexcept {
        return with_bits(etlprove::marked(diagram));
    }
    etlprove::Diagram diagram() const noexcept { return etlprove::diagram_of(bits); }
    /// Whether it is at least 0.
    etlprove::Diagram at_zero() const noexcept { return etlprove::diagrams().at_zero(diagram()); }
    explicit operator uint32_t() const noexcept {
        if (!etlprove::is_measuring()) etlprove::stop(etlprove::kBranches);
        return bits;
    }
};

ETLMON_INLINE uint32_t bits_of(const float& x) noexcept {
    return detail::observe(x);
}
ETLMON_INLINE float float_of_bits(uint32_t bits) noexcept {
    return detail::from_bits(bits);
}
ETLMON_INLINE Key key_of(const float& x) noexcept {
    if (etlprove::is_measuring()) return Key(0);
    const etlprove::Diagram found = etlprove::numbers().at_least(x);
    if (found == etlprove::Numbers::kNoNumber) etlprove::ask_for(x);
    return Key::of(found);
}
constexpr Key kTop = Key::with_bits(etlprove::marked(etlprove::kAlways));
constexpr Key kBottom = Key::with_bits(etlprove::marked(etlprove::kNever));

/// The two constants.
ETLMON_INLINE float float_of(Key key) noexcept {
    if (key.bits == kTop.bits) return HUGE_VALF;
    if (key.bits == kBottom.bits) return -HUGE_VALF;
    if (!etlprove::is_measuring()) etlprove::stop(etlprove::kBranches);
    return 0;
}

inline Key min_of(Key a, Key b) noexcept {
    return Key::of(etlprove::diagrams().both(a.diagram(), b.diagram()));
}
inline Key max_of(Key a, Key b) noexcept {
    return Key::of(etlprove::diagrams().either(a.diagram(), b.diagram()));
}
inline Key operator-(Key a) noexcept {
    etlprove::uses().negates(a.diagram());
    return Key::of(etlprove::diagrams().negation(a.diagram()));
}
/// A comparison of values that differ ends the proof.
inline bool differ() noexcept {
    if (!etlprove::is_measuring()) etlprove::stop(etlprove::kBranches);
    return true;
}
constexpr bool operator!=(Key a, Key b) noexcept {
    return a.bits == b.bits ? false : differ();
}
constexpr bool operator==(Key a, Key b) noexcept {
    return !(a != b);
}
constexpr bool is_less(Key a, Key b) noexcept {
    return a != b && a.bits < b.bits;
}
constexpr bool operator<(Key a, Key b) noexcept {
    return is_less(a, b);
}
constexpr bool operator>(Key a, Key b) noexcept {
    return is_less(b, a);
}
constexpr bool operator<=(Key a, Key b) noexcept {
    return !is_less(b, a);
}
constexpr bool operator>=(Key a, Key b) noexcept {
    return !is_less(a, b);
}

constexpr bool min_of(bool a, bool b) noexcept {
    return a && b;
}
constexpr bool max_of(bool a, bool b) noexcept {
    return a || b;
}
ETLMON_INLINE float min_of(float a, float b) noexcept {
    return b < a ? b : a;
}
ETLMON_INLINE float max_of(float a, float b) noexcept {
    return a < b ? b : a;
}

struct Value {
    Key low;
    Key high;
};

constexpr Value kTrue{kTop, kTop};
constexpr Value kFalse{kBottom, kBottom};

inline Value min_of(Value a, Value b) noexcept {
    return {min_of(a.low, b.low), min_of(a.high, b.high)};
}
inline Value max_of(Value a, Value b) noexcept {
    return {max_of(a.low, b.low), max_of(a.high, b.high)};
}
inline Value negate(Value a) noexcept {
    return {-a.high, -a.low};
}

struct Register {
    struct End {
        uint32_t bits;
        constexpr operator Key() const noexcept { return Key::with_bits(bits); }
    };
    Key low;
    End high;

    constexpr operator Value() const noexcept { return {low, high}; }
    constexpr Register& operator=(Value value) noexcept {
        low = value.low;
        high.bits = value.high.bits;
        return *this;
    }
};

ETLMON_INLINE Value between(const float& low, const float& high) noexcept {
    return {key_of(low), key_of(high)};
}

template <class First, class Second, class Third, class... More>
constexpr auto min_of(First a, Second b, Third c, More... more) noexcept {
    return min_of(min_of(a, b), c, more...);
}
template <class First, class Second, class Third, class... More>
constexpr auto max_of(First a, Second b, Third c, More... more) noexcept {
    return max_of(max_of(a, b), c, more...);
}

template <class Value>
struct Lattice;

template <>
struct Lattice<Key> {
    using End = Key;
    static constexpr Key bottom() noexcept { return kBottom; }
    static constexpr Key top() noexcept { return kTop; }
};

template <>
struct Lattice<Value> {
    using End = Key;
    static constexpr Value bottom() noexcept { return kFalse; }
    static constexpr Value top() noexcept { return kTrue; }
};

}  // namespace ETLMON_BUILD
}  // namespace etlmon
