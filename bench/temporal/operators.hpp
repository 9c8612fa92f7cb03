// The cost of a step of a delay or a window of the runtime, compared with a plain recurrence acc =
// max(acc, x) of the same run and with a monotonic wedge, the usual structure for sliding maxima.
// Takes: the duration of the measurement. Gives: nanoseconds per step, worst single steps and
// ratios, printed and as JSON. Keeps true: every operator's state is in memory between steps, as in
// a monitor that is called.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "timing.hpp"

namespace bench {

/// Measures the operators whose name contains `only`.
nlohmann::json measure_operators(const std::string& only, Effort effort);

}  // namespace bench
