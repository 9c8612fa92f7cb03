// Names of functions that generated code has anyway, which no local may have.
#pragma once

#include <set>
#include <string>

#include "plan/plan.hpp"

namespace etlc::emit {

/// Returns the functions with an underscore in their names: of the runtime, and of the class, named
/// after predicates and monitors.
std::set<std::string> function_names(const plan::Plan& plan);

}  // namespace etlc::emit
