// What a Boolean monitor finds out of a stream only when a verdict asks for it.
// Takes: the streams. Gives: per stream, whether it waits to be asked and what asking may cost.
// Keeps true: only what keeps nothing from step to step may wait; robustness is computed always,
// since every part of it can matter.
#pragma once

#include <cstdint>
#include <vector>

#include "plan/program/stream.hpp"

namespace etlc::plan {

struct Plan;

/// In a Boolean monitor: an atom, or made of such; `known` says it of the streams before.
bool found_on_demand(const Stream& stream, const std::vector<bool>& known);

struct Demand {
    bool lazy = false;       ///< found on demand
    std::uint64_t work = 0;  ///< target elements that it may have to measure
    std::uint64_t asks = 1;  ///< of atoms and kept values, at most
    /// What it was found to be is kept, since several ask: else asking doubles with each level.
    bool keeps = false;
};
std::vector<Demand> demands(const Plan& plan);

}  // namespace etlc::plan
