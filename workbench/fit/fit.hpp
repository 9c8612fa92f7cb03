// Fits projections, targets and metrics to labelled demonstrations: `etlc fit`. The result does not
// depend on the number of threads, memory not on the length of episodes. A fit that is degenerate
// is refused, never regularised silently.
#pragma once

#include <optional>
#include <string>

#include "artifacts/fitted.hpp"
#include "check/model/model.hpp"
#include "diag/diag.hpp"
#include "fit/collect.hpp"

namespace etlc::fit {

struct Fit {
    fitted::File file;
    std::string report;
};

/// Returns nothing after an error.
std::optional<Fit> fit(const check::Model& model, const Request& request, diag::Sink& sink);

}  // namespace etlc::fit
