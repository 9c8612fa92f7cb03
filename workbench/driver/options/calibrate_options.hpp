// Options of `etlc calibrate`.
#pragma once

#include <CLI/CLI.hpp>

#include "driver/calibrate.hpp"

namespace etlc::driver {

void add_calibrate_options(CLI::App& app, CalibrateRequest& calibrate);

}  // namespace etlc::driver
