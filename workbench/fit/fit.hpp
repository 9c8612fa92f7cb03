// `etlc fit`: projections, targets and metrics from labelled demonstrations.
// Takes: a spec that may lack what it declares fitted(...), and the episodes. Gives: the file of
// fitted things and what a person should know about it. Keeps true: the result is the same whatever
// the number of threads; memory does not grow with the length of episodes; what cannot be fitted is
// refused, and nothing is regularised in silence.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "check/model/model.hpp"
#include "diag/diag.hpp"
#include "fit/request.hpp"
#include "fit/separation.hpp"
#include "fit/solve.hpp"
#include "artifacts/fitted.hpp"

namespace etlc::fit {

struct Fit {
    fitted::File file;
    std::string report;
};

/// Nothing where the sink now says why.
std::optional<Fit> fit(const check::Model& model, const Request& request, diag::Sink& sink);

/// What was fitted, to what, and how well it separates. `solutions`: per fitted thing.
std::string report(const check::Model& model, const Collection& collection,
                   const std::vector<Solution>& solutions, const Separations& separations);

}  // namespace etlc::fit
