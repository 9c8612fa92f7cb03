// How often measure() reads distances, which decides whether they get a local.
#pragma once

#include <map>

#include "plan/plan.hpp"

namespace etlc::emit {

/// Counts the predicates that read a distance; an expression counts twice.
std::map<check::Index, int> distance_uses(const plan::Plan& plan);

}  // namespace etlc::emit
