// The options of `etlc run`.
#pragma once

#include <CLI/CLI.hpp>

#include "driver/run/run.hpp"

namespace etlc::driver {

/// `lets`: of check::Options.
void add_run_options(CLI::App& app, RunRequest& run, bool& lets);

}  // namespace etlc::driver
