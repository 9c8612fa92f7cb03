// Which monitors and lets a part of the plan works for.
// Takes: a plan. Gives: per stream and per reading, the monitors and lets whose verdicts depend on
// it. Keeps true: a part none of which can change any more need not be computed.
#pragma once

#include <vector>

#include "plan/program/program.hpp"

namespace etlc::plan {

struct Dependents {
    /// Indices of plan.monitors, ascending; behind them those of plan.lets.
    std::vector<std::vector<std::size_t>> of_stream;
    std::vector<std::vector<std::size_t>> of_reading;
};

Dependents dependents(const Plan& plan);

}  // namespace etlc::plan
