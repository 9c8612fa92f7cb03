// How a command tells what it found.
#pragma once

#include <string>

#include "diag/diag.hpp"
#include "source/source.hpp"

namespace etlc::driver {

/// Prints the findings as `form` says, "text" or "json"; the exit status that they mean.
int conclude(const std::string& form, const source::File& file, const diag::Sink& sink);

}  // namespace etlc::driver
