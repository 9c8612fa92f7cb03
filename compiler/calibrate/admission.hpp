// Which episodes a guarantee may be taken from.
// Takes: what was read of every episode, and the episodes that thresholds behind it have seen.
// Gives: an error for each that voids the guarantee: a target among its frames, the same episode
// twice, one that was seen. Keeps true: every calibration asks here, and what is calibrated beyond
// this is exchangeable with what comes, as far as data can tell.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "calibrate/leaks.hpp"
#include "diag/diag.hpp"

namespace etlc::calibrate {

/// An episode that has been read to its end.
struct Recorded {
    std::string path;
    std::string hash;
    std::uint64_t frames = 0;
    std::optional<Leak> leak;  ///< the first one
};

/// "step 4 is row 1 of target 'home', from which 'at_home' measures"
std::string text(const check::Model& model, const Leak& leak);

/// `seen`: hashes of the episodes that thresholds in the model were calibrated on.
void refuse_void(const check::Model& model, const std::vector<const Recorded*>& episodes,
                 const std::vector<std::string>& seen, diag::Sink& sink);

template <class Episode>
void refuse_void(const check::Model& model, const std::vector<Episode>& episodes,
                 const std::vector<std::string>& seen, diag::Sink& sink) {
    std::vector<const Recorded*> recorded;
    for (const Episode& episode : episodes) recorded.push_back(&episode);
    refuse_void(model, recorded, seen, sink);
}

}  // namespace etlc::calibrate
