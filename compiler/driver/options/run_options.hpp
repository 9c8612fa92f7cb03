// The options of `etlc run`.
#pragma once

#include <CLI/CLI.hpp>

#include "driver/run/run.hpp"

namespace etlc::driver {

/// `lets`: of check::Options.
void add_run_options(CLI::App& app, RunRequest& run, bool& lets);

/// "" where there is none.
std::string mistake_in_run_call(const RunRequest& run);

}  // namespace etlc::driver
