// `etlc incident`: what the flight recorder of a monitor wrote.
// Takes: a compiled spec and the file of an incident. Gives: the incident as a table, as CSV, or as
// a trace with a spec that reads it. Keeps true: nothing is printed of a file that is damaged, or
// that a monitor of another spec, other data or other thresholds wrote.
#pragma once

#include <cstdint>
#include <string>

#include "driver/compile/compile.hpp"

namespace etlc::driver {

enum class IncidentFormat : std::uint8_t { table, csv, trace, spec };

struct IncidentRequest {
    std::string file;
    IncidentFormat format = IncidentFormat::table;
    std::string output = "-";
};

/// False where the sink now says why not.
bool incident(const source::File& spec, const Compiled& compiled, const IncidentRequest& request,
              diag::Sink& sink);

}  // namespace etlc::driver
