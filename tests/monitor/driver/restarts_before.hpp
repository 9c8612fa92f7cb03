// The steps at which the tests restart monitors, the same for the reference, the evaluator and
// compiled classes.
#pragma once

#include <stdint.h>

/// Returns whether restart_NAME() of the monitor is called before the step: occasionally, and
/// sometimes twice in a row.
constexpr bool restarts_before(uint64_t step, uint64_t monitor) {
  return (7 * step + 3 * monitor) % 23 == 5 || (7 * step + 3 * monitor) % 23 == 12;
}
