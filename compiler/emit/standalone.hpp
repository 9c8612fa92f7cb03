// A generated header with the runtime it needs pasted in: one file to copy into firmware.
// Takes: a header that includes etlmon/*.hpp, and for what: "portable", in standard C++ alone, or
// "host", with vectors and a version per instruction set. Gives: the same header that includes
// nothing but C's headers. Keeps true: each runtime file is pasted once a translation unit, however
// many such headers it includes; a portable one has no line of gnu.hpp or vectors/, nor the
// conditions that would include them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace etlc::emit {

/// A file of the runtime, as it was when etlc was built.
struct RuntimeFile {
    std::string_view name;  ///< "etlmon/temporal/window.hpp"
    std::string_view text;
};
const std::vector<RuntimeFile>& runtime_files();

std::string standalone(const std::string& header, std::string_view target);

}  // namespace etlc::emit
