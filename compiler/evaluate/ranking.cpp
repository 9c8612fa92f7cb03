#include "evaluate/ranking.hpp"

#include <algorithm>

namespace etlc::evaluate {

Ranking::Ranking(std::vector<Scored> frames) : frames_(std::move(frames)) {
    std::sort(frames_.begin(), frames_.end(),
              [](const Scored& a, const Scored& b) { return a.score < b.score; });
}

std::optional<double> Ranking::auroc(const std::vector<std::uint32_t>& weights) const {
    std::uint64_t positives = 0;
    std::uint64_t negatives = 0;
    double twice_pairs = 0;  // won by the positive frame, a tie being half a win
    for (std::size_t i = 0; i < frames_.size();) {
        const float score = frames_[i].score;
        std::uint64_t tied_positives = 0;
        std::uint64_t tied_negatives = 0;
        for (; i < frames_.size() && frames_[i].score == score; ++i)
            (frames_[i].positive ? tied_positives : tied_negatives) += weights[frames_[i].episode];
        twice_pairs += static_cast<double>(tied_positives) *
                       static_cast<double>(2 * negatives + tied_negatives);
        positives += tied_positives;
        negatives += tied_negatives;
    }
    if (positives == 0 || negatives == 0) return std::nullopt;
    return twice_pairs / 2 / static_cast<double>(positives) / static_cast<double>(negatives);
}

}  // namespace etlc::evaluate
