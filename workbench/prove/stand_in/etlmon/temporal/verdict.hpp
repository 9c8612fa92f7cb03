// SPDX-License-Identifier: MIT
// Stands in for the runtime's verdict.hpp when `etlc prove` compiles a class. Takes: values at the
// end of a step. Gives: a verdict that holds them, and its status by the conditions of the
// runtime's file. Keeps true: what a class asks of a verdict is a condition on the samples, on
// which it may branch.
#pragma once

#include <stdint.h>

#include "etlmon/temporal/value.hpp"

namespace etlprove {

/// Whether the class has a recorder, which copies each status and which no verdict depends on; and
/// how often it was copied in a step.
struct Recorded {
    bool is = false;
    uint32_t statuses = 0;
};
inline Recorded& recorded() {
    static Recorded kept;
    return kept;
}

class Word;

/// The bits of a status.
struct Status {
    Bit satisfied = false;
    Bit violated = false;
    Bit final = false;
    uint32_t decided = 0;

    constexpr Status() noexcept = default;
    constexpr Status(Bit is, Bit is_not, Bit for_good) noexcept
        : satisfied(is), violated(is_not), final(for_good), decided(1) {}
    constexpr Status(uint32_t bits) noexcept
        : satisfied((bits & 1) != 0),
          violated((bits & 2) != 0),
          final((bits & 8) != 0),
          decided(bits >> 2 & 1) {}
    operator uint32_t() const noexcept {
        if (recorded().is && ++recorded().statuses > 0) return 0;
        return (satisfied ? 1u : 0u) | (violated ? 2u : 0u) | decided << 2 | (final ? 8u : 0u);
    }
    operator Word() const noexcept { return Word(static_cast<uint32_t>(*this)); }
};

}  // namespace etlprove

namespace etlmon {
inline namespace ETLMON_BUILD {

template <class Self>
struct Answers {
    using Bit = etlprove::Bit;
    static constexpr uint8_t kSatisfied = 1;
    static constexpr uint8_t kViolated = 2;
    static constexpr uint8_t kDecided = 4;
    static constexpr uint8_t kFinal = 8;

    Bit alarm() const noexcept { return violated() && final(); }
    Bit fulfilled() const noexcept { return satisfied() && final(); }
    Bit open() const noexcept { return decided() && !final(); }
    Bit satisfied() const noexcept { return status().satisfied; }
    Bit violated() const noexcept { return status().violated; }
    Bit unknown() const noexcept { return decided() && !satisfied() && !violated(); }
    bool decided() const noexcept { return status().decided != 0; }
    Bit final() const noexcept { return status().final; }

private:
    const etlprove::Status& status() const noexcept {
        return static_cast<const Self*>(this)->status;
    }
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

/// A number of a verdict, which a class stores and does not read.
struct Shown {
    Key key;
    constexpr Shown(Key of) noexcept : key(of) {}
    constexpr Shown(float) noexcept : key(Key::with_bits(0)) {}
    operator float() const noexcept { etlprove::stop(etlprove::kBranches); }
};

struct Verdict : Answers<Verdict> {
    Shown robustness = Key::with_bits(0);
    Shown lower = Key::with_bits(0);
    Shown upper = Key::with_bits(0);
    Shown high = Key::with_bits(0);  ///< rho.high, of which the runtime keeps the sign
    etlprove::Status status;
};

/// The conditions of the runtime's file.
inline Verdict prefix_verdict(Value rho, Key lower, Key upper, bool complete = false) noexcept {
    const auto at_least_0 = [](Key key) { return etlprove::Bit::of(key.at_zero()); };
    return {{},
            rho.low,
            lower,
            upper,
            rho.high,
            {at_least_0(rho.low), !at_least_0(rho.high),
             complete || at_least_0(lower) || !at_least_0(upper)}};
}
inline Verdict sliding_verdict(Value rho) noexcept {
    Verdict verdict = prefix_verdict(rho, rho.low, rho.high);
    verdict.status.final = true;
    return verdict;
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
