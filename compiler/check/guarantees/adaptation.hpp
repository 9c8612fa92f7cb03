// calibrated(adaptive, alpha, gamma, lo, hi): a threshold that follows delayed labels.
// Takes: the words of the spec. Gives: the steps by which it moves, and where it may start. Keeps
// true: an update never rounds, so the bound on the miss rate (docs/calibration.md) holds of the
// float32 numbers themselves.
#pragma once

#include <optional>
#include <string>

#include "check/context/context.hpp"

namespace etlc::check {

inline constexpr std::string_view kAdaptiveForm =
    "calibrated(adaptive, alpha = 0.1, gamma = 0.01, lo = 0.1, hi = 0.6)";

/// How the threshold moves; nothing where gamma, lo or hi had an error, which is reported. `alpha`
/// is sound.
std::optional<Adaptation> check_adaptation(Context& context, const ast::Calibrated& written,
                                           const std::string& alpha);

/// The multiple of the grid next to `epsilon` on the side of more detections; nothing where epsilon
/// is not in the range.
std::optional<float> start(const Adaptation& adaptation, float epsilon, bool upper_bound);

/// "the calibrated threshold 0.7 of 'p' is not in [0.1, 0.6], in which it is to move": where
/// `start` gives nothing.
std::string outside(const Predicate& predicate, float epsilon);

}  // namespace etlc::check
