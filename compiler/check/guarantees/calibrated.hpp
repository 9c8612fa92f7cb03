// calibrated(METHOD, ...): thresholds that come from the thresholds file. An epsilon is accepted
// only if it was calibrated for the same method, alpha, predicate, target values and truth.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "check/context/context.hpp"

namespace etlc::check {

/// Returns the threshold with method and alpha, and epsilon NaN; nothing after an error.
std::optional<Threshold> check_calibrated(Context& context, const ast::Calibrated& written);

/// Checks the calibration of a whole monitor, which says against which error it is.
std::optional<Threshold> check_monitor_calibrated(Context& context, const ast::Calibrated& written);

/// Checks the calibration of a duration, which is conformal.
std::optional<Threshold> check_duration_calibrated(Context& context,
                                                   const ast::Calibrated& written);

/// Says what to write in place of an alpha or beta above 0.5.
std::string large_alpha_note(const std::string& alpha, std::string_view key = "alpha");

/// Returns the name of the method in specs and thresholds files, "conformal"; empty for literal
/// thresholds.
std::string_view method_name(ThresholdOrigin origin);

std::string_view word(Against against);  ///< "missed_alarm"

/// Returns the multiple of the grid next to `epsilon` on the side of more detections; nothing if
/// epsilon is out of range.
std::optional<float> start(const Adaptation& adaptation, float epsilon, bool upper_bound);

/// Returns the error message for an epsilon out of range.
std::string outside(const Predicate& predicate, float epsilon);

}  // namespace etlc::check
