// Calibrated durations: `F[0, calibrated(conformal, alpha = 0.05)] lifted`. The score of an episode
// is the least duration with which the monitor is not violated for good at its end (the greatest,
// where a longer one makes it falser), and the duration is the conformal quantile of these scores.
// So P(a new episode is violated for good at some step) <= alpha, whatever the predicates are
// worth.
#pragma once

#include <cstdint>
#include <string>

#include "check/context/context.hpp"

namespace etlc::check {

/// Notes the calibrated duration of the monitor whose formula is checked; false after an error.
/// `least`, `greatest`: what may stand in its place, in steps.
bool add_duration(Context& context, const ast::Calibrated& written, std::uint32_t least,
                  std::uint32_t greatest);

/// Checks that false alarms of the monitor, of which `monitor.duration` has been noted, are
/// monotone in it, and sets the direction.
void check_duration(Context& context, Monitor& monitor);

}  // namespace etlc::check
