#include "episodes/auroc.hpp"

#include <algorithm>
#include <cmath>

namespace etlc::episodes {

namespace {

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
    double negatives_left = static_cast<double>(std::count_if(
        frames.begin(), frames.end(), [](const RankedFrame& frame) { return !frame.positive; }));
    double positives_before = 0;
    for (std::size_t i = 0; i < frames.size();) {
        const std::size_t begin = i;
        double positives = 0;
        while (i < frames.size() && frames[i].score == frames[begin].score)
            positives += frames[i++].positive ? 1 : 0;
        const double negatives = static_cast<double>(i - begin) - positives;
        negatives_left -= negatives;
        for (std::size_t k = begin; k < i; ++k)
            visit(frames[k], frames[k].positive ? negatives_left + negatives / 2
                                                : positives_before + positives / 2);
        positives_before += positives;
    }
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
