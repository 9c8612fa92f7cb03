#include "driver/incident/options.hpp"

#include "driver/options/options.hpp"

namespace etlc::driver {

void add_incident_options(CLI::App& app, IncidentRequest& request) {
    add_choice<IncidentFormat>(
        app, "--format", request.format,
        {{"table", IncidentFormat::table},
         {"csv", IncidentFormat::csv},
         {"trace", IncidentFormat::trace},
         {"spec", IncidentFormat::spec}},
        "trace: what was measured, as a .csv file for etlc run and etlc explain; spec: the spec "
        "that reads that trace, with what was measured for inputs");
    app.add_option("-o,--output", request.output, "where to write it; - is standard output")
        ->type_name("FILE")
        ->capture_default_str();
}

}  // namespace etlc::driver
