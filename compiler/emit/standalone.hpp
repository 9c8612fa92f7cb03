// Pastes the runtime into a generated header: one file to copy into firmware, which includes only C
// headers. Target "portable" is standard C++, without gnu.hpp and vectors/; "host" has vectors and
// a version per instruction set. A translation unit may include several such headers and gets each
// runtime file once.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace etlc::emit {

/// A file of the runtime, embedded when etlc was built.
struct RuntimeFile {
    std::string_view name;  ///< "etlmon/temporal/window.hpp"
    std::string_view text;
};
const std::vector<RuntimeFile>& runtime_files();

std::string standalone(const std::string& header, std::string_view target);

}  // namespace etlc::emit
