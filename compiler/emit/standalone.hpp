// A generated header with the runtime it needs pasted in: one file to copy into firmware.
// Takes: a header that includes etlmon/*.hpp. Gives: the same header that includes nothing but C's
// headers. Keeps true: each runtime file is pasted once a translation unit, however many such
// headers it includes; its SPDX line stays.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace etlc::emit {

/// A file of the runtime, as it was when etlc was built.
struct RuntimeFile {
    std::string_view name;  ///< "etlmon/window.hpp"
    std::string_view text;
};
const std::vector<RuntimeFile>& runtime_files();

std::string standalone(const std::string& header);

}  // namespace etlc::emit
