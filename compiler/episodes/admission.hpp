// Which episodes a guarantee may be taken from.
// Takes: what was read of every episode, and the episodes that thresholds behind it have seen.
// Gives: an error for each that voids the guarantee: a target among its frames, the same episode
// twice, one that was seen, and one that shares most of its content with such a one. Keeps true:
// every calibration asks here, and what is calibrated beyond this is exchangeable with what comes,
// as far as data can tell; what the user answers for is counted.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "data/traces/overlap.hpp"
#include "diag/diag.hpp"
#include "episodes/leaks.hpp"
#include "episodes/recording.hpp"
#include "thresholds/thresholds.hpp"

namespace etlc::episodes {

template <class Episode>
std::vector<const Recorded*> recorded(const std::vector<Episode>& episodes) {
    std::vector<const Recorded*> result;
    for (const Episode& episode : episodes) result.push_back(&episode);
    return result;
}

/// "step 4 is row 1 of target 'home', from which 'at_home' measures"
std::string text(const check::Model& model, const Leak& leak);

/// "shares about 97 % of its content with"
std::string text(const data::Overlap& overlap);

/// Episodes that thresholds of a file were calibrated on.
class Seen {
public:
    /// `episodes`: hashes in the file.
    Seen(const thresholds::File& file, const std::vector<std::string>& episodes);
    std::optional<data::Overlap> find(const Recorded& episode) const;

private:
    std::vector<std::string> hashes_;  ///< sorted
    data::Recordings recordings_;
};

/// `before`: where thresholds in the model come from. `reason`: of --allow-overlap; with one,
/// overlaps short of equality and targets among the frames are counted and not refused.
thresholds::Allowance admit(const check::Model& model, const std::vector<const Recorded*>& episodes,
                            const thresholds::File& before, const std::string& reason,
                            diag::Sink& sink);

template <class Episode>
thresholds::Allowance admit(const check::Model& model, const std::vector<Episode>& episodes,
                            const thresholds::File& before, const std::string& reason,
                            diag::Sink& sink) {
    return admit(model, recorded(episodes), before, reason, sink);
}

/// Notes in the file what tells these episodes apart, and what was passed over, if anything was.
void record(const std::vector<const Recorded*>& episodes, const thresholds::Allowance& allowance,
            thresholds::File& file);

template <class Episode>
void record(const std::vector<Episode>& episodes, const thresholds::Allowance& allowance,
            thresholds::File& file) {
    record(recorded(episodes), allowance, file);
}

/// Where --allow-overlap was given and there was nothing to pass over.
std::string remark_on(const thresholds::Allowance& allowance);

}  // namespace etlc::episodes
