// The forms in which an incident is printed.
// Takes: a plan and an incident of its monitor. Gives: text.
#pragma once

#include <string>

#include "data/incident.hpp"
#include "plan/plan.hpp"

namespace etlc::driver {

/// For people: what it is about, what was compared with what, and a line a step.
std::string incident_table(const plan::Plan& plan, const data::Incident& incident);

/// For programs: a row a step, with all that was recorded.
std::string incident_csv(const plan::Plan& plan, const data::Incident& incident);

/// A trace of what was measured: a column `distance_P` for each predicate, and the bools.
std::string incident_trace(const plan::Plan& plan, const data::Incident& incident);

/// The spec with what that trace has for inputs: `predicate p = distance_p <= 0.4`. Nothing of the
/// incident is in it.
std::string incident_spec(const plan::Plan& plan);

}  // namespace etlc::driver
