// `etlc --explain CODE`: the text of codes.def for a code, and an example, a message from
// tests/spec/error that is embedded at build time.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "diag/diag.hpp"

namespace etlc::driver {

/// The output of etlc in a test of a code.
struct Example {
    std::string_view code;
    std::string_view printed;
};

/// Returns an example of every code.
const std::vector<Example>& examples();

/// Explains a code in text; returns "" for an unknown code.
std::string explain_code(std::string_view code);

/// Returns whether a word has the form of a code: E0204, W0801.
bool is_code(std::string_view text);

/// Runs `etlc --explain CODE` and returns the exit status.
int explain_code_command(std::string_view code);

}  // namespace etlc::driver
