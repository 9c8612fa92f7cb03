// A mismatch made small.
// Takes: a spec and trace on which something fails, and the test that finds that out. Gives: a spec
// of one monitor and a trace on which it still fails, where no single smaller step does. Keeps
// true: what it gives was seen to fail.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "reference/reference.hpp"

namespace etlc::tests {

/// A spec, a trace and what is wrong there.
struct Finding {
    std::string spec;
    reference::Trace trace;
    std::string mismatch;
};

/// What is wrong with this spec on this trace; nothing where all is well or the spec is refused.
using Trial = std::function<std::optional<std::string>(const std::string& spec,
                                                       const reference::Trace& trace)>;

/// `tries`: how often the trial may be run.
Finding shrink(const Finding& finding, const Trial& trial, int tries);

}  // namespace etlc::tests
