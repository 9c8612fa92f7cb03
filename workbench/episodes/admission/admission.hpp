// Which episodes a guarantee may be taken from.
// Takes: what was read of every episode, and the episodes that thresholds and fitted things behind
// it have seen.
// Gives: an error for each that voids the guarantee: a target among its frames, the same episode
// twice, one that was seen, and one that shares most of its content with such a one. Keeps true:
// every calibration asks here, and what is calibrated beyond this is exchangeable with what comes,
// as far as data can tell; what the user answers for is counted.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "diag/diag.hpp"
#include "episodes/recording.hpp"
#include "artifacts/fitted.hpp"
#include "artifacts/thresholds.hpp"

namespace etlc::episodes {

/// "step 4 is row 1 of target 'home', from which 'at_home' measures"
std::string text(const check::Model& model, const Leak& leak);

/// `before`: where thresholds in the model come from; `fitted`: where what is fitted does.
/// `reason`: of --allow-overlap; with one, overlaps short of equality and targets among the frames
/// are counted and not refused.
thresholds::Allowance admit(const check::Model& model, const Identities& episodes,
                            const thresholds::File& before, const fitted::File& fitted,
                            const std::string& reason, diag::Sink& sink);

/// For an evaluation: refuses what thresholds were calibrated on, or something was fitted on, and
/// counts overlaps with it where a `reason` allows them.
thresholds::Allowance admit_unseen(const Identities& episodes, const thresholds::File& thresholds,
                                   const fitted::File& fitted, const std::string& reason,
                                   diag::Sink& sink);

/// Notes in the file what tells these episodes apart, and what was passed over, if anything was.
void record(const Identities& episodes, const thresholds::Allowance& allowance,
            thresholds::File& file);

/// Where --allow-overlap was given and there was nothing to pass over.
std::string remark_on(const thresholds::Allowance& allowance);

}  // namespace etlc::episodes
