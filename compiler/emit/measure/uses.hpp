// How often measure() reads scalars and distances, which decides whether they get a local.
#pragma once

#include <map>

#include "plan/plan.hpp"

namespace etlc::emit {

/// Counts how often measure() names a scalar. A point is checked before it is measured.
std::map<check::Index, int> scalar_uses(const plan::Plan& plan);

/// Counts the predicates that read a distance; an expression counts twice.
std::map<check::Index, int> distance_uses(const plan::Plan& plan);

}  // namespace etlc::emit
