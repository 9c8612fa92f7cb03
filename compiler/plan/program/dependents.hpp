// The monitors and lets whose verdicts depend on each stream and reading. A part that can no longer
// change any of them need not be computed.
#pragma once

#include <vector>

#include "plan/program/program.hpp"

namespace etlc::plan {

struct Dependents {
    /// Indices of plan.monitors, ascending, then of plan.lets.
    std::vector<std::vector<std::size_t>> of_stream;
    std::vector<std::vector<std::size_t>> of_reading;
};

Dependents dependents(const Plan& plan);

}  // namespace etlc::plan
