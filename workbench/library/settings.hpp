// Parses options that the command line and the C interface share. Where a text is wrong, the
// functions return nothing, and `why` says what was found and what was expected.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "check/check.hpp"
#include "plan/recorder_plan.hpp"

namespace etlc::library {

/// Parses NAME=VALUE: other values for constants, each a number or a duration as in a spec. Every
/// name may be set once. `what`: the option that takes them.
std::optional<std::vector<check::Setting>> parse_settings(const std::vector<std::string>& words,
                                                          std::string_view what, std::string& why);

/// Parses --recorder BEFORE,AFTER,INCIDENTS: two durations or numbers of steps, and a number
/// from 1.
std::optional<plan::RecorderRequest> parse_recorder(std::string_view text, std::string& why);

}  // namespace etlc::library
