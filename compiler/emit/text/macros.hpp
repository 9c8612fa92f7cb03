// Names of the spec that are macros of some platform's headers.
// Takes: generated code. Gives: the same with directives around it, under which none of its names
// is a macro. Keeps true: behind it all macros are what they were before.
#pragma once

#include <string>

namespace etlc::emit {

std::string shielded(const std::string& code);

}  // namespace etlc::emit
