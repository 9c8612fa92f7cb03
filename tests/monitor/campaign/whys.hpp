// Compares why_NAME() of classes made with --explain with `etlc explain`.
#pragma once

#include <optional>
#include <string>

#include "check/model/model.hpp"
#include "compare.hpp"
#include "reference/reference.hpp"

namespace etlc::tests {

struct WhyTally {
    int asked = 0;    ///< verdicts with a compared sample
    int rounded = 0;  ///< of these, distances that differ from the measured one in some bit
};

/// Returns the first why_NAME() that is not the critical sample of its verdict, as text. Skips
/// verdicts that the class recognises as final earlier than the definition, because these have
/// different bounds.
std::optional<std::string> why_mismatch(const check::Model& model, const reference::Trace& trace,
                                        const Observed& observed, WhyTally& tally);

}  // namespace etlc::tests
