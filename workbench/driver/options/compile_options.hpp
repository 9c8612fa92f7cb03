// The options of `etlc SPEC.etl -o FILE`: what is made of the spec, and where it goes.
// Gives: a request and paths. Keeps true: a call that contradicts itself is refused with what is
// wrong about it.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "driver/compile.hpp"
#include "driver/output.hpp"

namespace etlc::driver {

void add_compile_options(CLI::App& app, Request& request, OutputPaths& output, bool& check_only);

/// What --retargetable does not go with, and why; empty where it was not asked for, or where there
/// is none.
std::string mistake_in_retargetable_call(const CLI::App& app, const Request& request);

/// The call's own mistakes that CLI11 cannot see; empty where there are none.
std::string mistake_in_compile_call(const CLI::App& app, const Request& request,
                                    const OutputPaths& output, bool check_only);

}  // namespace etlc::driver
