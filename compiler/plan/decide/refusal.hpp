// What is said of a formula or a class over the limits.
// Takes: the part or the plan, and the limits. Gives: diagnostics with all three figures, and notes
// at the operators that need them. Keeps true: a plan within the limits passes without a word.
#pragma once

#include "plan/budget/budget.hpp"
#include "plan/decide/readings.hpp"
#include "plan/program/program.hpp"

namespace etlc::plan {

/// A part of a monitor whose state machine would be larger than the limits.
void refuse_part(const check::Monitor& monitor, const ReadingBuilder::Oversize& part,
                 const ir::Graph& graph, const Limits& limits, check::Values values,
                 std::vector<diag::Note> alternatives, diag::Sink& sink);

/// A plan over the limits; advice is asked for the costliest monitor.
void check_budget(const Plan& plan, const Limits& limits, const Advice& advice, diag::Sink& sink);

}  // namespace etlc::plan
