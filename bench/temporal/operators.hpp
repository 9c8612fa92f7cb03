// What a step of a delay or a window of the runtime costs by itself, set against a plain recurrence
// acc = max(acc, x) of the same run and against a monotonic wedge, the usual structure for sliding
// maxima. Takes: how long to measure. Gives: nanoseconds a step, worst single steps and ratios,
// printed and as JSON. Keeps true: every operator's state is in memory between steps, as in a
// monitor that is stepped from elsewhere.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "timing.hpp"

namespace bench {

/// Of the operators whose name contains `only`.
nlohmann::json measure_operators(const std::string& only, Effort effort);

}  // namespace bench
