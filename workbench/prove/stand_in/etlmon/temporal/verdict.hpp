// SPDX-License-Identifier: MIT
// Stands in for the runtime's verdict.hpp when `etlc prove` compiles a class. Takes: values at the
// end of a step. Gives: a verdict that holds them, in place of the floats and the status that the
// runtime makes of them. Keeps true: a monitor restarts after the "final" verdicts that the proof
// chooses, any of them, in place of those that are.
#pragma once

#include <stdint.h>

#include "etlmon/temporal/value.hpp"

namespace etlprove {

/// The repeating monitors whose verdict counts as final at this step, a bit each, and the number of
/// them that have asked.
struct Finals {
    uint64_t chosen = 0;
    uint32_t asked = 0;
};
inline Finals& finals() {
    static Finals kept;
    return kept;
}

}  // namespace etlprove

namespace etlmon {
inline namespace ETLMON_BUILD {

template <class Self>
struct Answers {
    static constexpr uint8_t kSatisfied = 1;
    static constexpr uint8_t kViolated = 2;
    static constexpr uint8_t kDecided = 4;
    static constexpr uint8_t kFinal = 8;
};

template <class Value, uint32_t count>
struct Named {
    struct Entry {
        const char* name;
        Value verdict;
    };
    Entry entries[count];

    constexpr const Entry* begin() const noexcept { return entries; }
    constexpr const Entry* end() const noexcept { return entries + count; }
};

/// The bits of a status, which only the recorder copies, are all 0; its place holds rho.high.
struct Status {
    uint32_t high;
    constexpr operator uint32_t() const noexcept { return 0; }
};

/// A number of a verdict. As a float, for telemetry, it is not proved.
struct Shown {
    Key key;
    constexpr Shown(Key of) noexcept : key(of) {}
    operator float() const noexcept { return 0; }
};

struct Verdict : Answers<Verdict> {
    Shown robustness = Key::marked(0);
    Shown lower = Key::marked(0);
    Shown upper = Key::marked(0);
    Status status = {0};

    bool final() const noexcept {
        etlprove::Finals& finals = etlprove::finals();
        return (finals.chosen >> finals.asked++ & 1u) != 0;
    }
    /// Only counters, which are not proved, ask this after a final verdict.
    bool alarm() const noexcept { return false; }
    bool satisfied() const noexcept { etlprove::stop(etlprove::kBranches); }
    bool violated() const noexcept { etlprove::stop(etlprove::kBranches); }
};
static_assert(sizeof(Verdict) == 16, "as large as the runtime's");

inline Verdict prefix_verdict(Value rho, Key lower, Key upper) noexcept {
    return {{}, rho.low, lower, upper, {rho.high.bits}};
}
inline Verdict sliding_verdict(Value rho) noexcept {
    return {{}, rho.low, rho.low, rho.high, {rho.high.bits}};
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
