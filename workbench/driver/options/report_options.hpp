// The options of `etlc report`.
#pragma once

#include <CLI/CLI.hpp>

#include "driver/report/report.hpp"

namespace etlc::driver {

void add_report_options(CLI::App& app, ReportRequest& report);

}  // namespace etlc::driver
