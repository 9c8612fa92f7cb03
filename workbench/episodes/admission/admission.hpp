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
#include "fitted/fitted.hpp"
#include "thresholds/thresholds.hpp"

namespace etlc::episodes {

/// Tells rows of a target set that were taken from the frames of episodes from those that lie at
/// them by chance. What is equal to a row is a leak; what is within rounding of a row is one where
/// so many episodes would not have such a frame by chance, given how many frames lie near rows
/// (episodes/leaks/rounded_rows.hpp).
class LeakEvidence {
public:
    explicit LeakEvidence(const Identities& episodes);

    std::optional<Leak> of(const Recorded& episode) const;

private:
    std::vector<bool> leaks_;  ///< per set that frames are compared with
};

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
