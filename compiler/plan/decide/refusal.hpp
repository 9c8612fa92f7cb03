// Reports formulas and classes that exceed the limits, with all three figures and notes at the
// operators that need most.
#pragma once

#include "plan/budget/budget.hpp"
#include "plan/decide/readings.hpp"
#include "plan/program/program.hpp"

namespace etlc::plan {

/// Reports a part of a monitor whose state machine would exceed the limits.
void refuse_part(const check::Monitor& monitor, const ReadingBuilder::Oversize& part,
                 const ir::Graph& graph, const Limits& limits, check::Values values,
                 std::vector<diag::Note> alternatives, diag::Sink& sink);

/// Reports a plan that exceeds the limits; asks for advice on the costliest monitor.
void check_budget(const Plan& plan, const Limits& limits, const Advice& advice, diag::Sink& sink);

}  // namespace etlc::plan
