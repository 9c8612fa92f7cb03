// Makes the C++ between a generated class and driver/harness.hpp.
// Takes: the typed spec. Gives: source text that sets its inputs and reports its verdicts and
// telemetry by name.
#pragma once

#include <string>
#include <vector>

#include "check/model/model.hpp"

namespace etlc::tests {

/// Defines `void answer_SPEC()` for the class in "SPEC.hpp", which may have --explain. `session`:
/// harness::Session or another of driver/.
std::string adaptor_source(const check::Model& model, bool explains, const std::string& session);

/// Defines main, which serves the specs in this order.
std::string main_source(const std::vector<std::string>& specs);

}  // namespace etlc::tests
