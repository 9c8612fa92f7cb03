// What a call of etlc writes: the header or another stage, the files of large target sets and of
// parameters, what they depend on. Takes: what driver::emit gave. Keeps true: all of the files
// appear or none, whole.
#pragma once

#include <string>

#include "diag/diag.hpp"
#include "driver/compile/compile.hpp"

namespace etlc::driver {

struct OutputPaths {
    std::string result;   ///< of what --emit names; - is standard output
    std::string depfile;  ///< empty: not asked for
    std::string targets;  ///< where large target sets go; empty: nowhere
    std::string params;   ///< where the parameters of a retargetable class go; empty: nowhere
    /// By the call, which then expects the file even where nothing goes to it.
    bool targets_named = false;
};

/// Whatever cannot be written is reported.
void write_output(const OutputPaths& paths, const source::File& spec, const Output& output,
                  diag::Sink& sink);

}  // namespace etlc::driver
