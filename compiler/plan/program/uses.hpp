// How often the code of a step names a scalar input or a distance: one that is named once is read
// or measured in place.
#pragma once

#include <map>

#include "plan/program/program.hpp"

namespace etlc::plan {

/// Returns the number of uses by index of the model's inputs. A point is checked before it is
/// measured, which makes two of each scalar.
std::map<Index, int> scalar_uses(const Plan& plan);

/// Counts the predicates that read a distance; an expression counts twice.
std::map<Index, int> distance_uses(const Plan& plan);

}  // namespace etlc::plan
