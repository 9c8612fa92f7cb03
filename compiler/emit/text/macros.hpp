// Shields generated code from macros: of platform headers, and single capital letters. Directives
// around the code remove macros with names that it uses, and restore them after it.
#pragma once

#include <string>

namespace etlc::emit {

std::string shielded(const std::string& code);

}  // namespace etlc::emit
