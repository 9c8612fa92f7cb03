// What would fit in place of a monitor that exceeds the limits: rewritings, each really planned.
#pragma once

#include "check/model/model.hpp"
#include "plan/budget/budget.hpp"

namespace etlc::plan {

/// Returns rewritings of a monitor, with their costs. A call plans a few dozen times at most, and
/// stops doubling a window where it no longer fits. Refers to the model and the limits.
Advice advice_on(const check::Model& model, const Limits& limits, check::Values values);

}  // namespace etlc::plan
