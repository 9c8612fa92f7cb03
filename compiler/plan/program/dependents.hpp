// The monitors and lets whose verdicts depend on each stream and reading. A part that can no longer
// change any of them need not be computed.
#pragma once

#include <map>
#include <vector>

#include "plan/program/program.hpp"

namespace etlc::plan {

struct Dependents {
    /// Indices of plan.monitors, ascending, then of plan.lets.
    std::vector<std::vector<std::size_t>> of_stream;
    std::vector<std::vector<std::size_t>> of_reading;
};

Dependents dependents(const Plan& plan);

// How often the code of a step names a scalar input or a distance: one that is named once is read
// or measured in place.

/// Returns the number of uses by index of the model's inputs. A point is checked before it is
/// measured, which makes two of each scalar.
std::map<Index, int> scalar_uses(const Plan& plan);

/// Counts the predicates that read a distance; an expression counts twice.
std::map<Index, int> distance_uses(const Plan& plan);

}  // namespace etlc::plan
