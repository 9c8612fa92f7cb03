// calibrated(METHOD, ...): thresholds that come from the thresholds file.
// Takes: the words of the spec, later the file. Gives: epsilon.
// Keeps true: an epsilon is only taken from an entry that was calibrated for the same method, alpha, predicate, target
// values and truth.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "check/context.hpp"

namespace etlc::check {

/// The threshold with its method and alpha, epsilon still NaN; nothing where the words had an error, which is reported.
std::optional<Threshold> check_calibrated(Context& context, const ast::Calibrated& written);

}  // namespace etlc::check
