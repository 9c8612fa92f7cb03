// The timelines of one trace as an SVG picture, for papers and slides: `etlc run --svg`.
// Takes: the trace's tracks. Gives: what the page draws of it, without a program in it: a lane for
// each predicate and monitor, with its chart and the strips of what was said and what was true.
// Keeps true: the picture's size does not depend on the number of steps; where there are more steps
// than pixels, a line goes through the least and the greatest number of each pixel.
#pragma once

#include <string>

#include "report/tracks.hpp"

namespace etlc::report {

std::string picture_of_trace(const Scene& scene, const Tracks& tracks);

}  // namespace etlc::report
