// Minimises a mismatch.
// Takes: a spec and trace with a failure, and the test that detects it. Gives: a spec of one
// monitor and a trace that still fails, and that no single step makes smaller. Keeps true: the
// result was seen to fail.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "reference/reference.hpp"

namespace etlc::tests {

/// A spec, a trace and the failure.
struct Finding {
    std::string spec;
    reference::Trace trace;
    std::string mismatch;
};

/// Returns the failure of this spec on this trace; empty if there is none or the spec is refused.
using Trial = std::function<std::optional<std::string>(const std::string& spec,
                                                       const reference::Trace& trace)>;

/// `tries`: the limit on runs of the trial.
Finding shrink(const Finding& finding, const Trial& trial, int tries);

}  // namespace etlc::tests
