// Compiles a typed model to a plan: lowered, optimised, planned. All callers that need the plan of
// a model use this function, so only it knows the order of the stages.
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
    std::optional<plan::RecorderRequest> recorder;  ///< only for the class
};

/// A spec after all stages. The model stays at its address, since graph and plan point to it.
struct Compiled {
    std::unique_ptr<check::Model> model;
    std::unique_ptr<ir::Program> program;
    plan::Plan plan;
};

/// Returns nothing if the plan exceeds the limits, with an error in the sink.
std::optional<Compiled> compile(check::Model model, const Options& options, diag::Sink& sink);

}  // namespace etlc::pipeline
