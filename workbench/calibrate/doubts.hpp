// Doubts about a threshold that has been fitted.
// Takes: the scores of all labelled frames, and the threshold. Gives: warnings where the labels are
// doubtful, the distance does not tell them apart, or the threshold is so wide that nearly every
// frame is within.
// Keeps true: says nothing of what too few episodes leave open; changes no threshold.
#pragma once

#include "calibrate/fit.hpp"
#include "diag/diag.hpp"

namespace etlc::calibrate {

void warn_of_doubts(const check::Predicate& predicate, const Evidence& evidence,
                    const Fitted& fitted, diag::Sink& sink);

}  // namespace etlc::calibrate
