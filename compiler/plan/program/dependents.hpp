// Which monitors a part of the plan works for.
// Takes: a plan. Gives: per stream and per reading, the monitors whose verdicts depend on it. Keeps
// true: a part none of whose monitors can change any more need not be computed.
#pragma once

#include <vector>

#include "plan/plan.hpp"

namespace etlc::plan {

struct Dependents {
    std::vector<std::vector<std::size_t>> of_stream;   ///< indices of plan.monitors, ascending
    std::vector<std::vector<std::size_t>> of_reading;  ///< the same
};

Dependents dependents(const Plan& plan);

}  // namespace etlc::plan
