// `etlc --explain CODE`: what a code of a diagnostic means.
// Takes: the code. Gives: what codes.def says of it, and an example: a message of tests/spec/error,
// which are put into etlc at build time.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "diag/diag.hpp"

namespace etlc::driver {

/// What etlc printed in a test of a code.
struct Example {
    std::string_view code;
    std::string_view printed;
};

/// One of every code.
const std::vector<Example>& examples();

/// The diagnostic of this code, with its source and notes; empty where it is not there.
std::string message_of(std::string_view printed, std::string_view code);

/// For people. Of a code that does not exist nothing.
std::string explain_code(std::string_view code);

/// Whether it is written as a code: E0204, W0801.
bool is_code(std::string_view text);

/// The exit status of `etlc --explain CODE`.
int explain_code_command(std::string_view code);

}  // namespace etlc::driver
