// Formulas that are legal and surely not meant.
// Takes: the model, all formulas built. Gives: warnings, each once per operator or monitor.
// Keeps true: nothing is warned of that can be what someone wants: the message says why.
#pragma once

#include "check/context/context.hpp"

namespace etlc::check {

void warn_about_formulas(Context& context);

}  // namespace etlc::check
