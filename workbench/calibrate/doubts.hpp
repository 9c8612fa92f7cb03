// Doubts about a threshold that has been fitted.
// Takes: the scores of all labelled frames, and the threshold. Gives: warnings where the labels are
// doubtful, the distance does not tell them apart, or the threshold is so wide that nearly every
// frame is within; and where alpha asks for little.
// Keeps true: says nothing of what too few episodes leave open; changes no threshold.
#pragma once

#include <string>

#include "calibrate/fit.hpp"
#include "diag/diag.hpp"

namespace etlc::calibrate {

/// Where the threshold asks for a guarantee that most may miss; `name`: of what it belongs to.
void warn_of_large_alpha(const std::string& name, const check::Threshold& threshold,
                         diag::Sink& sink);

void warn_of_doubts(const check::Predicate& predicate, const Evidence& evidence,
                    const Fitted& fitted, diag::Sink& sink);

}  // namespace etlc::calibrate
