#include "episodes/auroc.hpp"

#include <algorithm>
#include <cmath>

namespace etlc::episodes {

namespace {

/// How many frames of a class, or how much they count.
struct Classes {
    double positives = 0;
    double negatives = 0;
};

/// Calls `visit(first, last, lower, tied)` for each run of frames of one score, `lower` being those
/// of lower scores. A frame counts as often as `weight(frame)` says.
template <class Frame, class Weight, class Visit>
void for_each_tie(Frame* begin, Frame* end, const Weight& weight, const Visit& visit) {
    Classes lower;
    while (begin != end) {
        Frame* const first = begin;
        Classes tied;
        for (; begin != end && begin->score == first->score; ++begin)
            (begin->positive ? tied.positives : tied.negatives) += weight(*begin);
        visit(first, begin, lower, tied);
        lower.positives += tied.positives;
        lower.negatives += tied.negatives;
    }
}

/// Of a group, or of an episode those that it has a part in.
struct Pairs {
    double ordered = 0;
    double within = 0;  ///< of these, both frames are of the episode
    double positives = 0;
    double negatives = 0;
};

/// Calls `visit(frame, ordered)` for each frame, with how many pairs it is in that are ordered.
template <class Visit>
void for_each_in_order(std::vector<RankedFrame>& frames, const Visit& visit) {
    std::sort(frames.begin(), frames.end(), [](const RankedFrame& a, const RankedFrame& b) {
        if (a.score != b.score) return a.score < b.score;
        return a.episode != b.episode ? a.episode < b.episode : a.step < b.step;
    });
    const auto positives = static_cast<double>(std::count_if(
        frames.begin(), frames.end(), [](const RankedFrame& frame) { return frame.positive; }));
    for_each_tie(
        frames.data(), frames.data() + frames.size(), [](const RankedFrame&) { return 1.0; },
        [&](RankedFrame* first, RankedFrame* last, const Classes& lower, const Classes& tied) {
            const double higher = positives - lower.positives - tied.positives;
            for (; first != last; ++first)
                visit(*first, first->positive ? lower.negatives + tied.negatives / 2
                                              : higher + tied.positives / 2);
        });
}

/// The pairs of a group, and of each episode in it.
Pairs count(std::vector<RankedFrame>& frames, std::vector<Pairs>& episodes) {
    Pairs all;
    for (const RankedFrame& frame : frames) {
        ++(frame.positive ? episodes[frame.episode].positives : episodes[frame.episode].negatives);
        ++(frame.positive ? all.positives : all.negatives);
    }
    for_each_in_order(frames, [&](RankedFrame& frame, double ordered) {
        const double pairs = frame.positive ? all.negatives : all.positives;
        frame.ordered = pairs > 0 ? ordered / pairs : 1;
        episodes[frame.episode].ordered += ordered;
        if (frame.positive) all.ordered += ordered;
    });
    std::vector<RankedFrame> by_episode = frames;
    std::stable_sort(
        by_episode.begin(), by_episode.end(),
        [](const RankedFrame& a, const RankedFrame& b) { return a.episode < b.episode; });
    for (auto begin = by_episode.begin(); begin != by_episode.end();) {
        const std::size_t episode = begin->episode;
        const auto end = std::find_if(begin, by_episode.end(), [&](const RankedFrame& frame) {
            return frame.episode != episode;
        });
        std::vector<RankedFrame> own(begin, end);
        for_each_in_order(own, [&](const RankedFrame& frame, double ordered) {
            if (frame.positive) episodes[episode].within += ordered;
        });
        begin = end;
    }
    return all;
}

}  // namespace

Ranking::Ranking(std::vector<Scored> frames, const std::vector<std::uint32_t>& folds)
    : frames_(std::move(frames)) {
    const auto fold = [&](const Scored& frame) { return folds.empty() ? 0 : folds[frame.episode]; };
    std::sort(frames_.begin(), frames_.end(), [&](const Scored& a, const Scored& b) {
        return fold(a) != fold(b) ? fold(a) < fold(b) : a.score < b.score;
    });
    for (std::size_t i = 0; i < frames_.size(); ++i)
        if (i == 0 || fold(frames_[i]) != fold(frames_[i - 1])) begins_.push_back(i);
    begins_.push_back(frames_.size());
}

std::optional<double> Ranking::auroc(const std::vector<std::uint32_t>& weights) const {
    double twice_ordered = 0;  // a tie is half a pair
    double pairs = 0;
    for (std::size_t fold = 0; fold + 1 < begins_.size(); ++fold) {
        Classes all;
        for_each_tie(
            frames_.data() + begins_[fold], frames_.data() + begins_[fold + 1],
            [&](const Scored& frame) { return weights[frame.episode]; },
            [&](const Scored*, const Scored*, const Classes& lower, const Classes& tied) {
                twice_ordered += tied.positives * (2 * lower.negatives + tied.negatives);
                all = {lower.positives + tied.positives, lower.negatives + tied.negatives};
            });
        pairs += all.positives * all.negatives;
    }
    if (pairs == 0) return std::nullopt;
    return twice_ordered / 2 / pairs;
}

std::optional<Auroc> auroc(std::vector<std::vector<RankedFrame>>& groups, std::size_t episodes) {
    constexpr std::size_t kLeastEpisodes = 5;
    std::vector<Pairs> of_groups;
    std::vector<Pairs> of_episodes(episodes);
    double ordered = 0;
    double pairs = 0;
    for (std::vector<RankedFrame>& group : groups) {
        of_groups.push_back(count(group, of_episodes));
        ordered += of_groups.back().ordered;
        pairs += of_groups.back().positives * of_groups.back().negatives;
    }
    if (pairs == 0) return std::nullopt;

    std::vector<double> without_one;
    for (std::size_t g = 0; g < groups.size(); ++g) {
        const Pairs& group = of_groups[g];
        std::size_t last = episodes;
        std::vector<std::size_t> there;
        for (const RankedFrame& frame : groups[g]) there.push_back(frame.episode);
        std::sort(there.begin(), there.end());
        for (const std::size_t episode : there) {
            if (episode == last) continue;
            last = episode;
            const Pairs& own = of_episodes[episode];
            const double others =
                pairs - group.positives * group.negatives +
                (group.positives - own.positives) * (group.negatives - own.negatives);
            if (others > 0) without_one.push_back((ordered - own.ordered + own.within) / others);
        }
    }
    Auroc result{ordered / pairs, {}};
    if (without_one.size() < kLeastEpisodes) return result;
    const auto n = static_cast<double>(without_one.size());
    double mean = 0;
    for (const double value : without_one) mean += value / n;
    double squares = 0;
    for (const double value : without_one) squares += (value - mean) * (value - mean);
    const double margin = 1.96 * std::sqrt((n - 1) / n * squares);
    result.interval = {std::max(0.0, result.value - margin), std::min(1.0, result.value + margin)};
    return result;
}

}  // namespace etlc::episodes
