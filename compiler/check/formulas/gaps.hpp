// What a missing sample may do to the verdicts of a monitor, at worst.
// Takes: the model. Gives: per monitor, whose samples matter, and for how long one that is missing
// may leave the verdict unknown. Keeps true: never shorter than it can be; some other sample may
// decide the verdict earlier.
#pragma once

#include <limits>
#include <vector>

#include "check/model/model.hpp"

namespace etlc::check {

struct Gap {
    static constexpr std::uint64_t kForGood = std::numeric_limits<std::uint64_t>::max();

    /// Those that stand for nothing where they are missing (`missing false`); empty: the monitor
    /// is never unknown.
    std::vector<Index> inputs;
    std::uint64_t steps = 0;  ///< of unknown verdicts; kForGood
};

/// Parallel to model.monitors.
std::vector<Gap> gaps(const Model& model);

}  // namespace etlc::check
