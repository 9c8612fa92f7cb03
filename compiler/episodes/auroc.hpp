// How well a score tells two classes of frames apart: the area under the ROC curve, with an
// interval over episodes.
// Takes: a score and a class per frame, in groups within which scores can be compared. Gives: the
// part of the pairs of a positive and a negative frame of one group that the score orders, a tie
// being half a pair; and per frame, of how many of its pairs that is so. Keeps true: exact, no
// binning; the interval leaves out one episode at a time (jackknife), for frames of one episode are
// not independent.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace etlc::episodes {

struct RankedFrame {
    float score = 0;  ///< the smaller, the more likely positive
    bool positive = false;
    std::size_t episode = 0;
    std::size_t step = 0;
    double ordered = 0;  ///< part of the pairs with this frame that are ordered as they should be
};

struct Auroc {
    struct Interval {
        double low = 0;
        double high = 0;
    };
    double value = 0;
    std::optional<Interval> interval;  ///< of 95 %, where there are enough episodes
};

/// Frames of an episode are in one group. Sorts the frames and sets their `ordered`. Nothing where
/// no group has frames of both classes.
std::optional<Auroc> auroc(std::vector<std::vector<RankedFrame>>& groups, std::size_t episodes);

}  // namespace etlc::episodes
