// The options that commands share which read a spec: how it is compiled, and how findings are told.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "check/check.hpp"
#include "driver/compile.hpp"

namespace etlc::driver {

/// --set
void add_set_option(CLI::App& app, std::vector<check::Setting>& settings);

/// --fitted
void add_fitted_option(CLI::App& app, std::string& path);

/// --embedded
void add_embedded_option(CLI::App& app, std::string& path);

/// -W, --diagnostics
void add_diagnostics_options(CLI::App& app, std::vector<std::string>& warnings,
                             std::string& diagnostics);

/// The above that are about a spec, --thresholds, --values, --targets-as and the limits.
void add_compiler_options(CLI::App& app, Request& request);

}  // namespace etlc::driver
