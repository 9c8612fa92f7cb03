// The command line, read by the table of options. The only unit that sees CLI11.
#pragma once

#include <optional>
#include <string>

#include "driver/options/call.hpp"

namespace etlc::driver {

/// Says what is wrong with the call of "etlc run"; the exit status.
int complain(const std::string& command, const std::string& mistake);

/// Fills in the call. An exit status where the command ends here: --help, --version, a wrong call.
std::optional<int> parse(int argc, char** argv, Call& call);

}  // namespace etlc::driver
