// The area under the ROC curve, by frame: the share of pairs of a positive and a negative frame of
// one group that the score orders, a tie being half a pair (Mann-Whitney). Scores are comparable
// within a group. It is exact, without binning. Frames of one episode are dependent, so intervals
// are over episodes.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "data/spill/spill.hpp"

namespace etlc::episodes {

/// A labelled frame.
struct Scored {
    float score = 0;  ///< not NaN
    std::uint32_t episode = 0;
    bool positive = false;
};

template <class Archive>
void fields(Archive& archive, Scored& frame) {
    archive(frame.score, frame.episode, frame.positive);
}

/// Labelled frames, sorted by score; frames of an episode with equal scores are adjacent. Memory is
/// that of data::Sorted, however many there are.
class FramesByScore {
public:
    /// Adds a frame, before any visit. Fewer than 2^31 episodes.
    void add(const Scored& frame) {
        positives_ += frame.positive ? 1 : 0;
        const std::uint32_t rest = frame.episode << 1U | (frame.positive ? 1U : 0U);
        keys_.add(std::uint64_t{key_of(frame.score)} << 32U | rest);
    }

    std::uint64_t size() const { return keys_.size(); }
    std::uint64_t positives() const { return positives_; }
    std::uint64_t negatives() const { return size() - positives_; }

    /// Calls `visit(frame)` for each; a score of -0 is 0.
    template <class Visit>
    void for_each(const Visit& visit) const {
        keys_.for_each([&](std::uint64_t key) {
            const auto rest = static_cast<std::uint32_t>(key);
            visit(Scored{score_of(static_cast<std::uint32_t>(key >> 32U)), rest >> 1U,
                         (rest & 1U) != 0});
        });
    }

private:
    static constexpr std::uint32_t kSign = 1U << 31U;

    /// Returns a key that sorts as the scores do.
    static std::uint32_t key_of(float score) {
        const auto bits = std::bit_cast<std::uint32_t>(score == 0 ? 0.0F : score);
        return (bits & kSign) != 0 ? ~bits : bits | kSign;
    }
    static float score_of(std::uint32_t key) {
        return std::bit_cast<float>((key & kSign) != 0 ? key & ~kSign : ~key);
    }

    data::Sorted<std::uint64_t> keys_;
    std::uint64_t positives_ = 0;
};

struct Interval {
    double low = 0;
    double high = 0;
};

/// A figure, if it is defined, and its 95 % interval over episodes, if they are enough for one.
struct Figure {
    std::optional<double> value;
    std::optional<Interval> interval;
};

/// Return "0.912 [0.851, 0.953]"; "-" where it is undefined.
std::string shown(const Figure& figure);
std::string shown(const std::optional<double>& value);

/// The weight of each episode in every resample. The weights of an episode are adjacent, so that
/// sums of all resamples take one pass.
class Weights {
public:
    using Weight = std::uint16_t;

    /// Gives each episode this weight in every resample.
    Weights(std::size_t episodes, std::size_t resamples, Weight weight)
        : resamples_(resamples), weights_(episodes * resamples, weight) {}

    std::size_t resamples() const { return resamples_; }
    std::size_t episodes() const { return resamples_ == 0 ? 0 : weights_.size() / resamples_; }
    /// Returns the weights of an episode, one per resample.
    const Weight* operator[](std::size_t episode) const {
        return weights_.data() + episode * resamples_;
    }
    Weight* operator[](std::size_t episode) { return weights_.data() + episode * resamples_; }

private:
    std::size_t resamples_;
    std::vector<Weight> weights_;  ///< by episode, then by resample
};

struct RankedFrame : Scored {
    std::size_t step = 0;
    double ordered = 0;  ///< share of the pairs with this frame that are ordered correctly
};

/// Returns the AUROC; sorts the frames and sets their `ordered`. All frames of an episode are in
/// one group. Undefined where no group has frames of both classes. The interval is a jackknife,
/// which takes one pass however many episodes there are.
Figure auroc(std::vector<std::vector<RankedFrame>>& groups, std::size_t episodes);

/// Returns the AUROC of one group in which smaller scores indicate positive frames, without
/// per-frame results, in some 50 bytes an episode.
Figure auroc(const FramesByScore& frames, std::size_t episodes);

/// Returns the value of every resample; nothing where a class is empty.
std::vector<std::optional<double>> auroc(const std::vector<FramesByScore>& groups,
                                         const Weights& weights);

}  // namespace etlc::episodes
