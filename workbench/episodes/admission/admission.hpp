// Decides which episodes a guarantee may rest on. Refuses those that void it: with a target among
// their frames, used twice, used by a fit or a calibration before, mostly equal to such an episode,
// or of its group. Every calibration asks here, so what is calibrated is exchangeable with future
// episodes as far as data can show; overlaps that the user allows are counted.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "artifacts/fitted.hpp"
#include "artifacts/thresholds.hpp"
#include "diag/diag.hpp"
#include "episodes/recording.hpp"

namespace etlc::episodes {

/// Decides whether rows of a target set were taken from frames of the episodes. A frame equal to a
/// row is a leak. A frame within rounding of a row is one if so many episodes would not have such
/// frames by chance, given how many lie near rows (episodes/leaks/rounded_rows.hpp).
class LeakEvidence {
public:
    explicit LeakEvidence(const Identities& episodes);

    std::optional<Leak> of(const Recorded& episode) const;

private:
    std::vector<bool> leaks_;  ///< per watched set
};

/// Describes a leak: "step 4 is row 1 of target 'home', from which 'at_home' measures".
std::string text(const check::Model& model, const Leak& leak);

/// Admits episodes for calibration. `before` and `fitted`: the origin of thresholds and fits in the
/// model. `reason`: the argument of --allow-overlap; with it, targets among the frames and overlaps
/// short of equality are counted instead of refused.
thresholds::Allowance admit(const check::Model& model, const Identities& episodes,
                            const thresholds::File& before, const fitted::File& fitted,
                            const std::string& reason, diag::Sink& sink);

/// Admits episodes for evaluation: refuses those that thresholds were calibrated on or something
/// was fitted on, and counts overlaps with them if `reason` allows these.
thresholds::Allowance admit_unseen(const Identities& episodes, const thresholds::File& thresholds,
                                   const fitted::File& fitted, const std::string& reason,
                                   diag::Sink& sink);

/// Records the identities of the episodes in the file, and the allowed overlaps, if any.
void record(const Identities& episodes, const thresholds::Allowance& allowance,
            thresholds::File& file);

/// Remarks that --allow-overlap was not needed.
std::string remark_on(const thresholds::Allowance& allowance);

}  // namespace etlc::episodes
