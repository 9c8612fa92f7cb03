// The options of etlc fit.
#pragma once

#include <CLI/CLI.hpp>

#include "driver/fit.hpp"

namespace etlc::driver {

void add_fit_options(CLI::App& app, FitRequest& request);

/// What was said of --suggest, after parsing: whether it was there, and the predicates.
void read_suggest_option(const CLI::App& app, FitRequest& request);

}  // namespace etlc::driver
