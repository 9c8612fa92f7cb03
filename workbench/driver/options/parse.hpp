// The command line, read by the table of options. The only unit that sees CLI11.
#pragma once

#include <optional>
#include <string>

#include "driver/options/call.hpp"

namespace etlc::driver {

/// What `etlc COMMAND --help` says besides the options.
struct CommandText {
    std::string name;     ///< "etlc", "etlc run"
    std::string summary;  ///< may have several lines
    std::string footer;
};

/// Fills in the call. An exit status where the command ends here: --help, --version, a wrong call.
std::optional<int> parse(const CommandText& text, int argc, char** argv, Call& call);

}  // namespace etlc::driver
