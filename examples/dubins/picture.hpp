// A picture of one drive.
// Takes: a recording. Gives: an SVG page: distances with their thresholds over time, bars of what
// the predicates and the monitors said beside the truth, the path seen from above, and what the
// camera saw on the way.
#pragma once

#include <string>

#include "monitoring.hpp"

namespace demo {

std::string picture(const Recording& recording, int number);

}  // namespace demo
