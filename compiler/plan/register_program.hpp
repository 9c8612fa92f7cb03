// The registers of a small state machine, updated by straight-line code.
// Takes: a machine of the plan. Gives: an order of updates, each a max of min(max of registers,
// literals). Keeps true: after all updates the registers are what machine_advance would have made
// of them.
//
// Where every way into S followed by the guard h is also a way into T, those ways are one: min(S
// after its update, h). So F (a && F b) is S = max(S, a); T = max(T, min(S, b)): a chain where the
// transitions alone give a triangle.
#pragma once

#include <cstdint>
#include <vector>

#include "plan/plan.hpp"

namespace etlc::plan {

/// A register as an update reads it.
struct Source {
    std::uint32_t state = 0;
    bool updated = false;  ///< this step's value, else that of the step before

    bool operator==(const Source&) const = default;
};

/// min(max of the sources, literals); without sources the literals alone: a source that is always
/// true adds nothing.
struct Term {
    std::vector<Source> sources;
    std::vector<Slot> literals;
};

struct Update {
    std::uint32_t state = 0;
    std::vector<Term> terms;  ///< none: the register becomes false
};

struct RegisterProgram {
    std::vector<Update> updates;
    /// No update reads the old value of a register that an earlier one has written: no copies are
    /// needed.
    bool in_place = false;
};

RegisterProgram make_register_program(const Machine& machine);

/// Minima and maxima of values that it performs.
std::size_t operations(const RegisterProgram& program);

}  // namespace etlc::plan
