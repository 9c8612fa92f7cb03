#include "episodes/ranking/auroc.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace etlc::episodes {

namespace {

/// Numbers of frames per class.
struct Classes {
    double positives = 0;
    double negatives = 0;
};

/// Pairs of a group, or those of an episode with the group.
struct Pairs {
    double ordered = 0;
    double within = 0;  ///< ordered pairs with both frames in the episode
    double positives = 0;
    double negatives = 0;
};

/// The frames of an episode with one score.
struct Alike {
    std::uint32_t episode = 0;
    Classes frames;
};

/// Counts the ordered pairs of a group, in halves: exact in any order.
class PairCounter {
public:
    /// `positives`: of the group; `lower_negatives`: per episode, initially 0.
    PairCounter(double positives, std::vector<Pairs>& episodes,
                std::vector<double>& lower_negatives)
        : positives_(positives), episodes_(episodes), lower_negatives_(lower_negatives) {}

    /// Adds a frame, in ascending order of the score; frames of an episode with one score come
    /// together.
    void add(float score, std::uint32_t episode, bool positive) {
        if (!tied_.empty() && score != score_) end_tie();
        score_ = score;
        if (tied_.empty() || tied_.back().episode != episode) tied_.push_back({episode, {}});
        Classes& frames = tied_.back().frames;
        (positive ? frames.positives : frames.negatives) += 1;
    }

    Pairs finish() {
        end_tie();
        return {ordered_, 0, lower_.positives, lower_.negatives};
    }

private:
    void end_tie() {
        Classes all;
        for (const Alike& alike : tied_) {
            all.positives += alike.frames.positives;
            all.negatives += alike.frames.negatives;
        }
        const double of_positive = lower_.negatives + all.negatives / 2;
        const double of_negative =
            positives_ - lower_.positives - all.positives + all.positives / 2;
        for (const auto& [episode, frames] : tied_) {
            Pairs& own = episodes_[episode];
            double& own_lower = lower_negatives_[episode];
            own.positives += frames.positives;
            own.negatives += frames.negatives;
            own.ordered += frames.positives * of_positive + frames.negatives * of_negative;
            own.within += frames.positives * (own_lower + frames.negatives / 2);
            own_lower += frames.negatives;
        }
        ordered_ += all.positives * of_positive;
        lower_.positives += all.positives;
        lower_.negatives += all.negatives;
        tied_.clear();
    }

    double positives_;
    std::vector<Pairs>& episodes_;
    std::vector<double>& lower_negatives_;
    float score_ = 0;
    std::vector<Alike> tied_;
    Classes lower_;
    double ordered_ = 0;
};

double of_class(const std::vector<RankedFrame>& frames, bool positive) {
    return static_cast<double>(
        std::count_if(frames.begin(), frames.end(),
                      [&](const RankedFrame& frame) { return frame.positive == positive; }));
}

void sort_by_score(std::vector<RankedFrame>& frames) {
    std::sort(frames.begin(), frames.end(), [](const RankedFrame& a, const RankedFrame& b) {
        if (a.score != b.score) return a.score < b.score;
        return a.episode != b.episode ? a.episode < b.episode : a.step < b.step;
    });
}

/// Sets the share of ordered pairs of each frame; frames are in ascending order of the score.
void set_ordered(std::vector<RankedFrame>& frames, const Pairs& all) {
    Classes lower;
    for (std::size_t i = 0, end = 0; i < frames.size(); i = end) {
        Classes tied;
        for (; end < frames.size() && frames[end].score == frames[i].score; ++end)
            (frames[end].positive ? tied.positives : tied.negatives) += 1;
        const double higher = all.positives - lower.positives - tied.positives;
        for (std::size_t k = i; k < end; ++k) {
            const double ordered = frames[k].positive ? lower.negatives + tied.negatives / 2
                                                      : higher + tied.positives / 2;
            const double pairs = frames[k].positive ? all.negatives : all.positives;
            frames[k].ordered = pairs > 0 ? ordered / pairs : 1;
        }
        lower.positives += tied.positives;
        lower.negatives += tied.negatives;
    }
}

struct Group {
    Pairs all;
    std::vector<Pairs> episodes;  ///< per episode; 0 without frames in the group
};

/// `without_one`: the value without each episode.
Figure with_interval(double value, const std::vector<double>& without_one) {
    constexpr std::size_t kLeastEpisodes = 5;
    Figure result{value, {}};
    if (without_one.size() < kLeastEpisodes) return result;
    const auto n = static_cast<double>(without_one.size());
    double mean = 0;
    for (const double one : without_one) mean += one / n;
    double squares = 0;
    for (const double one : without_one) squares += (one - mean) * (one - mean);
    const double margin = 1.96 * std::sqrt((n - 1) / n * squares);
    result.interval = Interval{std::max(0.0, value - margin), std::min(1.0, value + margin)};
    return result;
}

Figure auroc_of(const std::vector<Group>& groups) {
    double ordered = 0;
    double pairs = 0;
    for (const Group& group : groups) {
        ordered += group.all.ordered;
        pairs += group.all.positives * group.all.negatives;
    }
    if (pairs == 0) return {};

    std::vector<double> without_one;
    without_one.reserve(groups[0].episodes.size());
    for (const auto& [all, episodes] : groups)
        for (const Pairs& own : episodes) {
            if (own.positives + own.negatives == 0) continue;
            const double others = pairs - all.positives * all.negatives +
                                  (all.positives - own.positives) * (all.negatives - own.negatives);
            if (others > 0) without_one.push_back((ordered - own.ordered + own.within) / others);
        }
    return with_interval(ordered / pairs, without_one);
}

/// Counts, for one group in every resample, twice the ordered pairs (a tie is half a pair).
class ResampledPairs {
public:
    explicit ResampledPairs(std::size_t resamples)
        : ordered_twice_(resamples),
          positives_(resamples),
          negatives_(resamples),
          tied_positives_(resamples),
          tied_negatives_(resamples) {}

    void add(const FramesByScore& frames, const Weights& weights) {
        std::optional<Scored> first;  // first frame with a score
        bool is_tied = false;
        const auto end_score = [&] {
            if (is_tied)
                end_tie();
            else if (first)
                add_alone(*first, weights[first->episode]);
        };
        frames.for_each([&](const Scored& frame) {
            if (!first || frame.score != first->score) {
                end_score();
                first = frame;
                is_tied = false;
                return;
            }
            if (!is_tied) add_tied(*first, weights[first->episode]);
            add_tied(frame, weights[frame.episode]);
            is_tied = true;
        });
        end_score();
    }

    double ordered(std::size_t resample) const { return ordered_twice_[resample] / 2; }
    double pairs(std::size_t resample) const { return positives_[resample] * negatives_[resample]; }

private:
    using Sums = std::vector<double>;

    void add_alone(const Scored& frame, const Weights::Weight* weights) {
        const std::size_t resamples = positives_.size();
        if (!frame.positive) {
            for (std::size_t r = 0; r < resamples; ++r) negatives_[r] += weights[r];
            return;
        }
        for (std::size_t r = 0; r < resamples; ++r) {
            const double weight = weights[r];
            ordered_twice_[r] += 2 * weight * negatives_[r];
            positives_[r] += weight;
        }
    }

    void add_tied(const Scored& frame, const Weights::Weight* weights) {
        Sums& sums = frame.positive ? tied_positives_ : tied_negatives_;
        for (std::size_t r = 0; r < sums.size(); ++r) sums[r] += weights[r];
    }

    void end_tie() {
        for (std::size_t r = 0; r < positives_.size(); ++r) {
            ordered_twice_[r] += tied_positives_[r] * (2 * negatives_[r] + tied_negatives_[r]);
            positives_[r] += std::exchange(tied_positives_[r], 0);
            negatives_[r] += std::exchange(tied_negatives_[r], 0);
        }
    }

    Sums ordered_twice_;
    Sums positives_;
    Sums negatives_;
    Sums tied_positives_;  ///< of the current score, 0 between two
    Sums tied_negatives_;
};

}  // namespace

std::string shown(const Figure& figure) {
    std::string text = shown(figure.value);
    if (figure.interval)
        text += fmt::format(" [{:.3f}, {:.3f}]", figure.interval->low, figure.interval->high);
    return text;
}

std::string shown(const std::optional<double>& value) {
    return value ? fmt::format("{:.3f}", *value) : "-";
}

Figure auroc(std::vector<std::vector<RankedFrame>>& groups, std::size_t episodes) {
    std::vector<Group> counted;
    for (std::vector<RankedFrame>& frames : groups) {
        std::vector<Pairs> pairs(episodes);
        std::vector<double> lower_negatives(episodes);
        sort_by_score(frames);
        PairCounter counter(of_class(frames, true), pairs, lower_negatives);
        for (const RankedFrame& frame : frames)
            counter.add(frame.score, frame.episode, frame.positive);
        const Pairs all = counter.finish();
        set_ordered(frames, all);
        counted.push_back({all, std::move(pairs)});
    }
    return auroc_of(counted);
}

Figure auroc(const FramesByScore& frames, std::size_t episodes) {
    // Exchanging the classes orders pairs as negating scores does.
    std::vector<Pairs> pairs(episodes);
    std::vector<double> lower_negatives(episodes);
    PairCounter counter(static_cast<double>(frames.negatives()), pairs, lower_negatives);
    frames.for_each(
        [&](const Scored& frame) { counter.add(frame.score, frame.episode, !frame.positive); });
    const Pairs all = counter.finish();
    return auroc_of({{all, std::move(pairs)}});
}

std::vector<std::optional<double>> auroc(const std::vector<FramesByScore>& groups,
                                         const Weights& weights) {
    const std::size_t resamples = weights.resamples();
    std::vector<double> ordered(resamples);
    std::vector<double> pairs(resamples);
    for (const FramesByScore& frames : groups) {
        ResampledPairs group(resamples);
        group.add(frames, weights);
        for (std::size_t r = 0; r < resamples; ++r) {
            ordered[r] += group.ordered(r);
            pairs[r] += group.pairs(r);
        }
    }
    std::vector<std::optional<double>> result(resamples);
    for (std::size_t r = 0; r < resamples; ++r)
        if (pairs[r] > 0) result[r] = ordered[r] / pairs[r];
    return result;
}

}  // namespace etlc::episodes
