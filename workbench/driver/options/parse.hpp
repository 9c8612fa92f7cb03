// The command line, read by the table of options. The only unit that sees CLI11.
#pragma once

#include <optional>

#include "driver/options/call.hpp"

namespace etlc::driver {

/// Fills in the call. An exit status where the command ends here: --help, --version, a wrong call.
std::optional<int> parse(int argc, char** argv, Call& call);

}  // namespace etlc::driver
