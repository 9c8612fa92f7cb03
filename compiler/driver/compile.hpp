// The pipeline: .etl text -> tree -> model -> graph -> plan -> text.
// Takes: a request. Gives: the text asked for, or findings in the sink. Keeps true: each stage is a
// function from value to value; the pipeline stops after the first stage that found an error.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "check/check.hpp"
#include "diag/diag.hpp"
#include "ir/lower.hpp"
#include "plan/plan.hpp"
#include "source/source.hpp"

namespace etlc::driver {

/// A spec through all stages. The model stays where it is: graph and plan point to it.
struct Compiled {
    std::unique_ptr<check::Model> model;
    std::unique_ptr<ir::Program> program;
    plan::Plan plan;
};

struct Request {
    check::Options check;
    plan::Limits limits;
    check::Values values = check::Values::robustness;
    plan::Storage targets_as = plan::Storage::f32;
    std::string emit = "hpp";  ///< ast, graph, plan, or a backend of emit/backends.cpp
    std::string name_space;
    bool standalone = false;   ///< the header with the runtime in it
    std::string targets_file;  ///< name of the file beside the header, without folders
};

/// What a call of etlc writes.
struct Output {
    std::string text;                       ///< of request.emit
    std::vector<std::string> dependencies;  ///< every file that the spec loads
    Compiled compiled;  ///< of the header: its plan says what goes to the file of targets
};

std::optional<Compiled> compile(const source::File& file, const Request& request, diag::Sink& sink);

/// A model, as check/ gives it or made from such a one, through the stages after that.
std::optional<Compiled> compile(check::Model model, const plan::Limits& limits, diag::Sink& sink,
                                check::Values values = check::Values::robustness,
                                plan::Storage targets_as = plan::Storage::f32);

/// Nothing where there was an error.
std::optional<Output> emit(const source::File& file, const Request& request, diag::Sink& sink);

/// What --emit takes, each with a summary for --help.
std::vector<std::pair<std::string, std::string>> emittable();

}  // namespace etlc::driver
