// Compiles a spec to a plan: the order of the stages. Everything that needs a plan calls these
// functions; the back ends (emit/emit.hpp) turn it into a header, and the evaluator
// (execute/evaluator.hpp) executes it.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "check/check.hpp"
#include "diag/diag.hpp"
#include "ir/lower.hpp"
#include "plan/plan.hpp"
#include "plan/recorder_plan.hpp"
#include "source/source.hpp"

namespace etlc {

/// How a model is compiled.
struct CompileOptions {
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

/// Reads the file of a spec; reports an error where that fails.
bool read_spec(const std::string& path, source::File& file, diag::Sink& sink);

/// Parses, checks and compiles a spec; nothing where there was an error.
std::optional<Compiled> compile(const source::File& file, const check::Options& check,
                                const CompileOptions& options, diag::Sink& sink);

/// Lowers, optimises and plans a model; nothing, with an error, where the plan exceeds the limits.
std::optional<Compiled> compile(check::Model model, const CompileOptions& options,
                                diag::Sink& sink);

}  // namespace etlc
