// The options of the commands that compile a spec: what it is filled with, what its monitors
// compute with, and how large they may become. Gives: a request. Keeps true: every command
// understands these options alike.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "check/check.hpp"
#include "driver/compile.hpp"

namespace etlc::driver {

void add_set_option(CLI::App& app, std::vector<check::Setting>& settings);

void add_fitted_option(CLI::App& app, std::string& path);

/// Both, and all others.
void add_compiler_options(CLI::App& app, Request& request);

}  // namespace etlc::driver
