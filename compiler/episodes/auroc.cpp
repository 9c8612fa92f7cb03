#include "episodes/auroc.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

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

/// Calls `visit(frame, ordered)` for each frame of those of ascending scores, with how many pairs
/// it is in that are ordered.
template <class Frame, class Visit>
void for_each_in_order(Frame* begin, Frame* end, const Visit& visit) {
    const auto positives = static_cast<double>(
        std::count_if(begin, end, [](const Frame& frame) { return frame.positive; }));
    for_each_tie(
        begin, end, [](const Frame&) { return 1.0; },
        [&](Frame* first, Frame* last, const Classes& lower, const Classes& tied) {
            const double higher = positives - lower.positives - tied.positives;
            for (; first != last; ++first)
                visit(*first, first->positive ? lower.negatives + tied.negatives / 2
                                              : higher + tied.positives / 2);
        });
}

void sort_by_score(std::vector<RankedFrame>& frames) {
    std::sort(frames.begin(), frames.end(), [](const RankedFrame& a, const RankedFrame& b) {
        if (a.score != b.score) return a.score < b.score;
        return a.episode != b.episode ? a.episode < b.episode : a.step < b.step;
    });
}
void sort_by_score(std::vector<Scored>& frames) {
    std::sort(frames.begin(), frames.end(),
              [](const Scored& a, const Scored& b) { return a.score < b.score; });
}

/// Of each episode the pairs within it; gives the episodes. Sorts the frames.
std::vector<std::uint32_t> count_within(std::vector<Scored>& frames, std::vector<Pairs>& episodes) {
    std::sort(frames.begin(), frames.end(), [](const Scored& a, const Scored& b) {
        return a.episode != b.episode ? a.episode < b.episode : a.score < b.score;
    });
    std::vector<std::uint32_t> there;
    for (std::size_t begin = 0, end = 0; begin < frames.size(); begin = end) {
        const std::uint32_t episode = frames[begin].episode;
        while (end < frames.size() && frames[end].episode == episode) ++end;
        for_each_in_order(frames.data() + begin, frames.data() + end,
                          [&](const Scored& frame, double ordered) {
                              if (frame.positive) episodes[episode].within += ordered;
                          });
        there.push_back(episode);
    }
    return there;
}
std::vector<std::uint32_t> count_within(const std::vector<RankedFrame>& frames,
                                        std::vector<Pairs>& episodes) {
    std::vector<Scored> copies(frames.begin(), frames.end());
    return count_within(copies, episodes);
}

struct Group {
    Pairs all;
    std::vector<std::uint32_t> episodes;
};

/// The pairs of a group, and of each episode in it. Numbers of halves: exact in any order.
template <class Frame>
Group count(std::vector<Frame>& frames, std::vector<Pairs>& episodes) {
    Group group;
    for (const Frame& frame : frames) {
        ++(frame.positive ? episodes[frame.episode].positives : episodes[frame.episode].negatives);
        ++(frame.positive ? group.all.positives : group.all.negatives);
    }
    sort_by_score(frames);
    for_each_in_order(
        frames.data(), frames.data() + frames.size(), [&](Frame& frame, double ordered) {
            if constexpr (std::is_same_v<Frame, RankedFrame>) {
                const double pairs = frame.positive ? group.all.negatives : group.all.positives;
                frame.ordered = pairs > 0 ? ordered / pairs : 1;
            }
            episodes[frame.episode].ordered += ordered;
            if (frame.positive) group.all.ordered += ordered;
        });
    group.episodes = count_within(frames, episodes);
    return group;
}

/// `without_one`: the value without each of the episodes.
Auroc with_interval(double value, const std::vector<double>& without_one) {
    constexpr std::size_t kLeastEpisodes = 5;
    Auroc result{value, {}};
    if (without_one.size() < kLeastEpisodes) return result;
    const auto n = static_cast<double>(without_one.size());
    double mean = 0;
    for (const double one : without_one) mean += one / n;
    double squares = 0;
    for (const double one : without_one) squares += (one - mean) * (one - mean);
    const double margin = 1.96 * std::sqrt((n - 1) / n * squares);
    result.interval = {std::max(0.0, value - margin), std::min(1.0, value + margin)};
    return result;
}

template <class Frame>
std::optional<Auroc> auroc_of(std::vector<std::vector<Frame>>& frames, std::size_t episodes) {
    std::vector<Group> groups;
    std::vector<Pairs> of_episodes(episodes);
    double ordered = 0;
    double pairs = 0;
    for (std::vector<Frame>& group : frames) {
        groups.push_back(count(group, of_episodes));
        ordered += groups.back().all.ordered;
        pairs += groups.back().all.positives * groups.back().all.negatives;
    }
    if (pairs == 0) return std::nullopt;

    std::vector<double> without_one;
    for (const Group& group : groups)
        for (const std::uint32_t episode : group.episodes) {
            const Pairs& own = of_episodes[episode];
            const double others =
                pairs - group.all.positives * group.all.negatives +
                (group.all.positives - own.positives) * (group.all.negatives - own.negatives);
            if (others > 0) without_one.push_back((ordered - own.ordered + own.within) / others);
        }
    return with_interval(ordered / pairs, without_one);
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
    return auroc_of(groups, episodes);
}
std::optional<Auroc> auroc(std::vector<std::vector<Scored>>& groups, std::size_t episodes) {
    return auroc_of(groups, episodes);
}

}  // namespace etlc::episodes
