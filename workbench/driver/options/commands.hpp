// The commands, as people call them.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "driver/options/call.hpp"

namespace etlc::driver {

struct CommandText {
    std::string name;     ///< "etlc", "etlc run"
    std::string summary;  ///< may have several lines
    std::string footer;
};

CommandText text_of(Command command);

/// "run", ...
std::vector<std::string> command_names();
/// Nothing where the word names none.
std::optional<Command> command_named(std::string_view word);

}  // namespace etlc::driver
