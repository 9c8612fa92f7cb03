// calibrated(METHOD, ...): thresholds that come from the thresholds file.
// Takes: the words of the spec, later the file. Gives: epsilon.
// Keeps true: an epsilon is only taken from an entry that was calibrated for the same method,
// alpha, predicate, target values and truth.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "check/context/context.hpp"

namespace etlc::check {

/// The threshold with its method and alpha, epsilon still NaN; nothing where the words had an
/// error, which is reported.
std::optional<Threshold> check_calibrated(Context& context, const ast::Calibrated& written);

/// The same of a whole monitor, whose arguments are alpha and against.
std::optional<MonitorCalibration> check_monitor_calibrated(Context& context,
                                                           const ast::Calibrated& written);

/// How specs and thresholds files call the method: "conformal"; empty for a literal threshold.
std::string_view method_name(ThresholdOrigin origin);

std::string_view word(Against against);  ///< "missed_alarm"

}  // namespace etlc::check
