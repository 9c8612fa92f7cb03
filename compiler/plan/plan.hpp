// The entry of the stage: from the optimised graph to the plan of its monitors.
// Takes: the graph and the limits. Gives: the plan, or a diagnostic for each monitor that does not
// fit. Keeps true: nothing is approximated to fit.
#pragma once

#include <optional>
#include <vector>

#include "check/model/model.hpp"
#include "diag/diag.hpp"
#include "ir/lower.hpp"
#include "plan/budget/budget.hpp"
#include "plan/program/program.hpp"

namespace etlc::plan {

/// Plans every monitor, or reports the ones whose exact state, code or work exceeds the limits;
/// `advice` is asked once.
std::optional<Plan> plan(const ir::Program& program, const Limits& limits, diag::Sink& sink,
                         check::Values values = check::Values::robustness,
                         Storage targets_as = Storage::f32, const Advice& advice = {});

/// A plan without monitors: the evaluator then only measures these predicates, as it does for
/// monitors that use them.
Plan measuring(const check::Model& model, const std::vector<Index>& predicates);

}  // namespace etlc::plan
