// What would fit in place of a monitor that does not.
// Takes: a model, and one of its monitors that exceeds the limits. Gives: rewritings that are
// within them, with what they cost. Keeps true: each was really planned; a call plans a few dozen
// times at most, and stops doubling a window where it no longer fits.
#pragma once

#include <vector>

#include "pipeline/compile.hpp"

namespace etlc::pipeline {

/// `among`: all monitors of the model have to fit together, or this one by itself.
std::vector<diag::Note> alternatives(const check::Model& model, check::Index monitor,
                                     plan::Among among, const Options& options);

}  // namespace etlc::pipeline
