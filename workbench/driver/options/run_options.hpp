// The options of `etlc run`.
#pragma once

#include <CLI/CLI.hpp>

#include "check/check.hpp"
#include "driver/run/run.hpp"

namespace etlc::driver {

/// --lets and --retargetable go to `check`.
void add_run_options(CLI::App& app, RunRequest& run, check::Options& check);

/// "" where there is none.
std::string mistake_in_run_call(const RunRequest& run);

}  // namespace etlc::driver
