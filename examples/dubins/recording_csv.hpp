// A recorded drive as a trace for `etlc run`: columns px, py, z[0] ... z[31], a row a step.
#pragma once

#include <string>

#include "monitoring.hpp"

namespace demo {

/// Throws std::runtime_error where the file cannot be written.
void write_csv(const std::string& path, const Recording& recording);

}  // namespace demo
