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

namespace etlc::episodes {

struct Scored {
    float score = 0;  ///< the greater, the more likely positive
    std::uint32_t episode = 0;
    bool positive = false;
};

template <class Archive>
void fields(Archive& archive, Scored& frame) {
    archive(frame.score, frame.episode, frame.positive);
}

/// Frames in order, for those who ask with many weights: resamples of the episodes.
class Ranking {
public:
    /// `folds`: the groups, of each episode its own; empty: all are of one.
    explicit Ranking(std::vector<Scored> frames, const std::vector<std::uint32_t>& folds = {});

    /// With each episode's frames counted `weights[episode]` times; nothing where one of the
    /// classes is empty.
    std::optional<double> auroc(const std::vector<std::uint32_t>& weights) const;

private:
    std::vector<Scored> frames_;       ///< by fold, then by score
    std::vector<std::size_t> begins_;  ///< of each fold in them; at last their number
};

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
/// Where nothing is asked of a frame by itself, in less memory; the frames change their places.
std::optional<Auroc> auroc(std::vector<std::vector<Scored>>& groups, std::size_t episodes);

}  // namespace etlc::episodes
