// Traces of measurements in place of inputs: `distance_P` for each predicate P, and the bools.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "check/model/model.hpp"
#include "plan/plan.hpp"

namespace etlc::driver {

/// Returns a row of a CSV file.
std::string csv_line(std::vector<std::string> cells);

/// Names the column of a predicate, which is the `number`-th of the plan, from 1.
std::string measured_name(const check::Model& model, check::Index p, std::size_t number);

/// Returns the spec that reads such a trace: `predicate p = distance_p <= 0.4`.
std::string measured_spec(const plan::Plan& plan);

}  // namespace etlc::driver
