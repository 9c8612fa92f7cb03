// How well a score tells two classes of frames apart: the area under the ROC curve.
// Takes: a score and a class per frame, in groups within which scores can be compared. Gives: the
// part of the pairs of a positive and a negative frame of one group that the score orders, a tie
// being half a pair (Mann-Whitney); how much it may be off, from episode to episode; and per frame,
// of how many of its pairs that is so. Keeps true: exact, no binning; frames of one episode are not
// independent, so whatever says how sure it is counts episodes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "episodes/ranking/frames_by_score.hpp"
#include "episodes/ranking/weights.hpp"

namespace etlc::episodes {

struct RankedFrame : Scored {
    std::size_t step = 0;
    double ordered = 0;  ///< part of the pairs with this frame that are ordered as they should be
};

struct Auroc {
    struct Interval {
        double low = 0;
        double high = 0;
    };
    double value = 0;
    /// Of 95 %, where there are enough episodes: they are left out one at a time (jackknife), which
    /// takes one pass however many there are.
    std::optional<Interval> interval;
};

/// Frames of an episode are in one group. Sorts the frames and sets their `ordered`. Nothing where
/// no group has frames of both classes.
std::optional<Auroc> auroc(std::vector<std::vector<RankedFrame>>& groups, std::size_t episodes);
/// Which scores are the more likely positive.
enum class Likely : std::uint8_t { greater, smaller };

/// Of one group, where nothing is asked of a frame by itself: in memory of some 50 bytes an
/// episode.
std::optional<Auroc> auroc(const FramesByScore& frames, std::size_t episodes, Likely likely);

/// In every resample the value; nothing where one of the classes is empty.
std::vector<std::optional<double>> auroc(const std::vector<FramesByScore>& groups,
                                         const Weights& weights);

}  // namespace etlc::episodes
