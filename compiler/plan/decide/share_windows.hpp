// Many windows over one signal as one window and what each longer one adds.
// Takes: a plan whose streams are final but for this. Gives: the same streams, in which a window is
// widened from a shorter one over the same signal where that is at least half as long
// (etlmon::Widening). Keeps true: every value; operands may stand after what uses them until the
// plan puts them in order.
#pragma once

#include "plan/program/program.hpp"

namespace etlc::plan {

void share_windows(Plan& plan);

}  // namespace etlc::plan
