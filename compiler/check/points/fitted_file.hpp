// What was fitted, from its file.
// Takes: a row of model.fitted, and the file beside the spec. Gives: its entry. Keeps true: an
// entry is taken only where it was fitted for what the spec says now.
#pragma once

#include "check/context/context.hpp"
#include "artifacts/fitted.hpp"

namespace etlc::check {

/// The entry with the shape that the spec asks for; null where there is none, which is reported
/// unless it may be missing. The file is read at the first call.
const fitted::Entry* fitted_entry(Context& context, Index fitted);

}  // namespace etlc::check
