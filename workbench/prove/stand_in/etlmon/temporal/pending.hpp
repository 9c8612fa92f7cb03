// SPDX-License-Identifier: MIT
// Adds to the runtime's pending.hpp when `etlc prove` compiles a class: a formula at position 0,
// with the number of the step as a word that is alike from some step on, tables that are made of
// words, and the last truths without a place in a ring.
#pragma once

#define Recent RecentOfRuntime
#define PendingMachine PendingMachineOfRuntime
#include_next "etlmon/temporal/pending.hpp"
#undef Recent
#undef PendingMachine

#include <vector>

#include "etlmon/temporal/boolean_window.hpp"
#include "etlprove/space.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

template <class Value, uint32_t Length>
class Recent : public RecentOfRuntime<Value, Length> {};

template <uint32_t Length>
class Recent<Truth, Length> {
public:
    constexpr void reset() noexcept { last_.reset(kNo); }
    void push(Truth value) noexcept { last_.push(value); }
    void list(BasicReading<Truth>* out, uint32_t n) const noexcept {
        for (uint32_t p = 0; p < n; ++p) out[p] = settled(last_[Length - n + p]);
    }

private:
    etlprove::Last<Truth, Length> last_;
};

template <class Value, uint32_t States, uint32_t Width>
class PendingMachine : public PendingMachineOfRuntime<Value, States, Width> {
    using Base = PendingMachineOfRuntime<Value, States, Width>;
    using End = typename Lattice<Value>::End;

public:
    template <class Number>
    BasicReading<Value> read(const BasicReading<Value> (*guards)[Width], uint32_t n, bool settles,
                             const Transition* transitions, const Number* ends,
                             const Obligations* pending, const End* weak,
                             const End* strong) noexcept {
        const std::vector<uint32_t> all(ends, ends + States);
        return Base::read(guards, n, settles, transitions, all.data(), pending, weak, strong);
    }
};

/// From the step on at which all positions that are read are past `high`, or past `low` if nothing
/// is too late, and the operands are settled, the step does not count.
template <class Sense, class Value>
BasicReading<Value> pending_from_start(Value& best, Value& held,
                                       const typename detail::As<BasicReading<Value>>::Type* f,
                                       const BasicReading<Value>* g, uint32_t n,
                                       const etlprove::Word& step, uint32_t horizon, uint32_t low,
                                       uint32_t high,
                                       typename Lattice<Value>::End unseen) noexcept {
    const uint64_t last = high == kWithoutEnd ? low : uint64_t{high} + 1;
    const uint64_t alike = last + n > horizon ? last + n : horizon;
    return pending_from_start<Sense, Value>(
        best, held, f, g, n, static_cast<uint32_t>(step.up_to(alike)), horizon, low, high, unseen);
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
