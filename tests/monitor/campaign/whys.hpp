// What classes made with --explain say of their verdicts, held to `etlc explain`.
#pragma once

#include <optional>
#include <string>

#include "check/model/model.hpp"
#include "compare.hpp"
#include "reference/reference.hpp"

namespace etlc::tests {

struct WhyTally {
    int asked = 0;    ///< verdicts whose sample was compared
    int rounded = 0;  ///< of these: their distance is not the one measured, to the bit
};

/// The first why_NAME() that is not the critical sample of its verdict, as text. Verdicts that the
/// class finds to be final before their definition does are left out: these have bounds of their
/// own.
std::optional<std::string> why_mismatch(const check::Model& model, const reference::Trace& trace,
                                        const Observed& observed, WhyTally& tally);

}  // namespace etlc::tests
