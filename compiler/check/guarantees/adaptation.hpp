// calibrated(adaptive, alpha, gamma, lo, hi): a threshold that follows delayed labels. Updates
// never round, so the bound on the miss rate (docs/calibration.md) holds for the float32 numbers.
#pragma once

#include <optional>
#include <string>

#include "check/context/context.hpp"

namespace etlc::check {

inline constexpr std::string_view kAdaptiveForm =
    "calibrated(adaptive, alpha = 0.1, gamma = 0.01, lo = 0.1, hi = 0.6)";

/// Returns how the threshold moves; nothing after an error in gamma, lo or hi. `alpha` is valid.
std::optional<Adaptation> check_adaptation(Context& context, const ast::Calibrated& written,
                                           const std::string& alpha);

/// Returns the multiple of the grid next to `epsilon` on the side of more detections; nothing if
/// epsilon is out of range.
std::optional<float> start(const Adaptation& adaptation, float epsilon, bool upper_bound);

/// Returns the error message for an epsilon out of range.
std::string outside(const Predicate& predicate, float epsilon);

}  // namespace etlc::check
