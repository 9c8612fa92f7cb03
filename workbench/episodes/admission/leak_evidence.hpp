// Whether rows of a target set were taken from the frames of episodes, or lie at them by chance.
// Takes: what was read of all episodes of a call. Gives: of each its first leak. Keeps true: what
// is equal to a row is one; what is within rounding of a row is one where so many episodes would
// not have such a frame by chance, given how many frames lie near rows
// (episodes/leaks/near_rows.hpp).
#pragma once

#include <optional>
#include <vector>

#include "episodes/recording.hpp"

namespace etlc::episodes {

class LeakEvidence {
public:
    explicit LeakEvidence(const Identities& episodes);

    std::optional<Leak> of(const Recorded& episode) const;

private:
    std::vector<bool> leaks_;  ///< per set that frames are compared with
};

}  // namespace etlc::episodes
