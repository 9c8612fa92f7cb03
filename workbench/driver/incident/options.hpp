// The options of `etlc incident`.
#pragma once

#include <CLI/CLI.hpp>

#include "driver/incident/incident.hpp"

namespace etlc::driver {

void add_incident_options(CLI::App& app, IncidentRequest& request);

}  // namespace etlc::driver
