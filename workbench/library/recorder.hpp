// `--recorder BEFORE,AFTER,INCIDENTS`: what a flight recorder keeps.
// Takes: the words of the call. Gives: two durations or numbers of steps, and a number from 1 on.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "plan/recorder_plan.hpp"

namespace etlc::library {

/// Nothing where the text is something else: `why` then says what was found.
std::optional<plan::RecorderRequest> parse_recorder(std::string_view text, std::string& why);

}  // namespace etlc::library
