// The streams that a Boolean monitor evaluates only on demand of a verdict. Only streams without
// memory can wait; robustness is always computed, since every part of it can matter.
#pragma once

#include <cstdint>
#include <vector>

#include "plan/program/stream.hpp"

namespace etlc::plan {

struct Plan;

/// Returns whether a stream of a Boolean monitor is evaluated on demand: an atom, or made of such;
/// `known` has the answer for the streams before it.
bool found_on_demand(const Stream& stream, const std::vector<bool>& known);

struct Demand {
    bool lazy = false;       ///< evaluated on demand
    std::uint64_t work = 0;  ///< target elements that it may measure
    std::uint64_t asks = 1;  ///< queries of atoms and kept values, at most
    /// Whether its result is kept because several streams use it: otherwise queries double with
    /// each level.
    bool keeps = false;
};
std::vector<Demand> demands(const Plan& plan);

}  // namespace etlc::plan
