// Whether an entry of the thresholds file agrees with itself.
// Takes: the entry, and which side of its scores the threshold is on. Gives: the first number that
// does not follow from the others, with what was found and what was expected. Keeps true: rank and
// threshold are computed again from alpha and the scores by the arithmetic of `etlc calibrate`, so
// a number that was changed by itself is not believed.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "artifacts/thresholds.hpp"

namespace etlc::check {

/// What contradicts the rest: "'predicates.at_a.k' is 1, expected 37: the rank of alpha = 0.1 among
/// 40 scores".
struct Contradiction {
    std::string message;
    bool by_hand = false;  ///< the threshold itself: somebody may have wished for another one
};

/// `place`: the entry's key, "predicates.at_a". `upper_bound`: the threshold is above the scores
/// that it takes in, as that of <= and < and the shift against missed alarms. `episodes`: those
/// that it was calibrated on.
std::optional<Contradiction> contradiction(const thresholds::Entry& entry, const std::string& place,
                                           bool upper_bound,
                                           const std::vector<std::uint64_t>& episodes);

/// One of `episodes` that is among those behind the file's predicates, or shares most of its
/// content with one of them and was not allowed to; nothing where there is none.
std::optional<std::uint64_t> shared_episode(const std::vector<std::uint64_t>& episodes,
                                            const thresholds::File& file);

}  // namespace etlc::check
