// SPDX-License-Identifier: MIT
// Adds to the runtime's machine.hpp when `etlc prove` compiles a class: its tables are made of
// words, and a machine over truths has one set of registers, so that its state is the same on every
// way through a step.
#pragma once

#define Machine MachineOfRuntime
#include_next "etlmon/temporal/machine.hpp"
#undef Machine

#include <vector>

#include "etlmon/temporal/truth.hpp"
#include "etlprove/space.hpp"

namespace etlprove {

inline std::vector<uint32_t> numbers_of(const Word* words, uint32_t count) {
    return std::vector<uint32_t>(words, words + count);
}

}  // namespace etlprove

namespace etlmon {
inline namespace ETLMON_BUILD {

template <class Value, uint32_t States>
class Machine : public MachineOfRuntime<Value, States> {
    using Base = MachineOfRuntime<Value, States>;

public:
    using Base::advance;
    void advance(const Transition* transitions, const etlprove::Word* ends,
                 const Value* guards) noexcept {
        Base::advance(transitions, etlprove::numbers_of(ends, States).data(), guards);
    }
};

template <uint32_t States>
class Machine<Truth, States> {
public:
    constexpr void reset() noexcept {
        for (uint32_t q = 0; q < States; ++q) registers_[q] = q == 0 ? kYes : kNo;
    }
    template <class Number>
    void advance(const Transition* transitions, const Number* ends, const Truth* guards) noexcept {
        Truth next[States];
        const std::vector<uint32_t> all(ends, ends + States);
        machine_advance(registers_, next, States, transitions, all.data(), guards);
        for (uint32_t q = 0; q < States; ++q) registers_[q] = next[q];
    }
    template <class End>
    BasicReading<Truth> read(const Obligations* pending, const End* weak,
                             const End* strong) const noexcept {
        return machine_read(registers_, States, pending, weak, strong);
    }

private:
    Truth registers_[States];
};

}  // namespace ETLMON_BUILD
}  // namespace etlmon
