// Monitors one drive with the generated class, beside the truth.
// Takes: an episode and the encoder. Gives: per step the embedding, the distances, the verdicts and
// the true verdicts. Keeps true: the truth depends on the car's position only, not on anything that
// the monitor computed.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

#include "encoder.hpp"
#include "episode.hpp"

namespace demo {

inline constexpr std::array<std::string_view, 3> kPredicates{"at_a", "at_b", "near_c"};
inline constexpr std::array<std::string_view, 4> kMonitors{"reach", "avoid", "reach_avoid",
                                                           "sequential"};
extern const std::array<float, 3> kThresholds;  ///< one per predicate, from the generated class

struct Claim {
    bool satisfied = false;
    bool final = false;  ///< whether the verdict is final
    float robustness = 0;
};

struct Step {
    Embedding embedding;
    std::array<float, kPredicates.size()> distances;
    std::array<bool, kPredicates.size()> seen;       ///< the predicates
    std::array<bool, kPredicates.size()> true_now;   ///< their intended meaning
    std::array<Claim, kMonitors.size()> claims;      ///< the monitors' verdicts on the steps so far
    std::array<bool, kMonitors.size()> true_so_far;  ///< the same formulas over the truth
};

struct Recording {
    Episode episode;
    std::vector<Step> steps;
};

/// Renders, encodes and monitors a drive, step by step.
Recording monitor_drive(Episode episode, const Encoder& encoder);

}  // namespace demo
