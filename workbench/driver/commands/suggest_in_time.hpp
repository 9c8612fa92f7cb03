// Judges formulas over time for `etlc fit --suggest`: all candidates in one text of the spec,
// trained and judged as `etlc crossvalidate` would.
#pragma once

#include "driver/commands/request.hpp"
#include "fit/suggest/suggest.hpp"

namespace etlc::driver {

/// Returns the ranked candidates, or why there are none: an error in training or judging them is no
/// error of the call.
fit::SuggestedInTime suggest_in_time(const source::File& file, const check::Model& model,
                                     const fit::Suggested& suggested, const Request& request,
                                     const fit::Request& asked);

}  // namespace etlc::driver
