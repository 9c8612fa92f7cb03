// Plans monitors: from the optimised graph to the operations of every step. Nothing is approximated
// to fit the limits.
#pragma once

#include <optional>
#include <vector>

#include "check/model/model.hpp"
#include "diag/diag.hpp"
#include "ir/lower.hpp"
#include "plan/budget/budget.hpp"
#include "plan/program/program.hpp"

namespace etlc::plan {

/// Plans every monitor, or reports those whose exact state, code or work exceeds the limits; calls
/// `advice` once.
std::optional<Plan> plan(const ir::Program& program, const Limits& limits, diag::Sink& sink,
                         check::Values values = check::Values::robustness,
                         Storage targets_as = Storage::f32, const Advice& advice = {});

/// Returns a plan without monitors, with which the evaluator only measures these predicates.
Plan measuring(const check::Model& model, const std::vector<Index>& predicates);

}  // namespace etlc::plan
