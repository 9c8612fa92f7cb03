// The options of `etlc explain`.
#pragma once

#include <CLI/CLI.hpp>

#include "driver/explain/explain.hpp"

namespace etlc::driver {

void add_explain_options(CLI::App& app, ExplainRequest& request);

}  // namespace etlc::driver
