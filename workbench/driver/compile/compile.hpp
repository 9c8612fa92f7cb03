// The whole way: .etl text -> tree -> model -> graph -> plan -> text.
// Takes: a request. Gives: the text asked for, or findings in the sink. Keeps true: each stage is a
// function from value to value; nothing runs after the first stage that found an error.
#pragma once

#include <optional>
#include <string>

#include "check/check.hpp"
#include "diag/diag.hpp"
#include "pipeline/compile.hpp"
#include "source/source.hpp"

namespace etlc::driver {

using pipeline::Compiled;

struct Request : pipeline::Options {
    check::Options check;
    bool explain = false;      ///< the class says why: why_NAME()
    std::string emit = "hpp";  ///< ast, graph, plan, or a backend of emit/backends.cpp
    std::string name_space;
    std::string standalone;    ///< the header with the runtime in it: emit::Options::standalone
    std::string targets_file;  ///< name of the file beside the header, without folders
};

/// What a call of etlc writes.
struct Output {
    std::string text;                       ///< of request.emit
    std::vector<std::string> dependencies;  ///< every file that the spec loads
    Compiled compiled;   ///< of the header: its plan says what goes to the file of targets
    std::string params;  ///< of a retargetable class: what goes to the file of parameters
};

std::optional<Compiled> compile(const source::File& file, const Request& request, diag::Sink& sink);

/// Nothing where there was an error.
std::optional<Output> emit(const source::File& file, const Request& request, diag::Sink& sink);

/// What --emit takes, each with a summary for --help.
std::vector<std::pair<std::string, std::string>> emittable();

}  // namespace etlc::driver
