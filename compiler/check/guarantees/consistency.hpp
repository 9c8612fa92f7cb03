// Checks that an entry of the thresholds file is consistent. Rank and threshold are computed again
// from alpha and the scores as in `etlc calibrate`, so a number changed alone is detected.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "artifacts/thresholds.hpp"

namespace etlc::check {

/// The first inconsistent number: "'predicates.at_a.k' is 1, expected 37: the rank of alpha = 0.1
/// among 40 scores".
struct Contradiction {
    std::string message;
    bool by_hand = false;  ///< the threshold itself, which somebody may have edited
};

/// `place` is the key of the entry, "predicates.at_a". `upper_bound`: the threshold is above the
/// accepted scores, as for <= and < and for a shift against missed alarms. `episodes` were used for
/// calibration.
std::optional<Contradiction> contradiction(const thresholds::Entry& entry, const std::string& place,
                                           bool upper_bound,
                                           const std::vector<std::uint64_t>& episodes,
                                           const thresholds::GroupNames& groups);

/// Returns one of `episodes` that the file's predicates were calibrated on, or that shares most of
/// its content or its group with one of those without permission; nothing if there is none.
std::optional<std::uint64_t> shared_episode(const std::vector<std::uint64_t>& episodes,
                                            const thresholds::File& file);

}  // namespace etlc::check
