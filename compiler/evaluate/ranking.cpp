#include "evaluate/ranking.hpp"

#include <algorithm>

namespace etlc::evaluate {

namespace {

/// Pairs of a positive and a negative frame.
struct Pairs {
    double twice_won = 0;  // by the positive one, a tie being half a win
    double all = 0;
};

/// `begin` to `end`: frames by score.
Pairs pairs(const Scored* begin, const Scored* end, const std::vector<std::uint32_t>& weights) {
    std::uint64_t positives = 0;
    std::uint64_t negatives = 0;
    Pairs result;
    while (begin != end) {
        const float score = begin->score;
        std::uint64_t tied_positives = 0;
        std::uint64_t tied_negatives = 0;
        for (; begin != end && begin->score == score; ++begin)
            (begin->positive ? tied_positives : tied_negatives) += weights[begin->episode];
        result.twice_won += static_cast<double>(tied_positives) *
                            static_cast<double>(2 * negatives + tied_negatives);
        positives += tied_positives;
        negatives += tied_negatives;
    }
    result.all = static_cast<double>(positives) * static_cast<double>(negatives);
    return result;
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
    Pairs sum;
    for (std::size_t fold = 0; fold + 1 < begins_.size(); ++fold) {
        const Pairs here =
            pairs(frames_.data() + begins_[fold], frames_.data() + begins_[fold + 1], weights);
        sum.twice_won += here.twice_won;
        sum.all += here.all;
    }
    if (sum.all == 0) return std::nullopt;
    return sum.twice_won / 2 / sum.all;
}

}  // namespace etlc::evaluate
