// `--set NAME=VALUE`: other values for the constants of a spec.
// Takes: the words of the call. Gives: settings, each a number or a duration as a spec would write
// it. Keeps true: each name stands once.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "check/check.hpp"

namespace etlc::library {

/// Nothing where a word is not NAME=VALUE, or sets a name again: `why` then says so.
std::optional<std::vector<check::Setting>> parse_settings(const std::vector<std::string>& words,
                                                          std::string& why);

}  // namespace etlc::library
