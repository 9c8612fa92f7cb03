// The parts of the table of options that are in files of their own.
#pragma once

#include <vector>

#include "driver/options/option.hpp"

namespace etlc::driver {

/// Returns the options of `etlc report` and `etlc label`, and of `etlc prove`, that no other
/// command has.
std::vector<Option> options_of_pages();
std::vector<Option> options_of_proofs();

}  // namespace etlc::driver
