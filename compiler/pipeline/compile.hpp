// From the typed model to the plan: lowered, optimised, planned.
// Takes: a model, as check/ gives it or made from such a one (a ground truth, say), and the limits.
// Gives: the plan with all that it points to. Keeps true: one place that knows this order; whoever
// needs the plan of a model asks here.
#pragma once

#include <memory>
#include <optional>

#include "check/model/model.hpp"
#include "diag/diag.hpp"
#include "ir/lower.hpp"
#include "plan/plan.hpp"
#include "plan/recorder_plan.hpp"

namespace etlc::pipeline {

/// How a model is compiled.
struct Options {
    plan::Limits limits;
    check::Values values = check::Values::robustness;
    plan::Storage targets_as = plan::Storage::f32;
    std::optional<plan::RecorderRequest> recorder;  ///< of the class; nothing else has one
};

/// A spec through all stages. The model stays where it is: graph and plan point to it.
struct Compiled {
    std::unique_ptr<check::Model> model;
    std::unique_ptr<ir::Program> program;
    plan::Plan plan;
};

/// Nothing where the plan exceeds the limits, as the sink then says.
std::optional<Compiled> compile(check::Model model, const Options& options, diag::Sink& sink);

}  // namespace etlc::pipeline
