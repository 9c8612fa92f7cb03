#include "calibrate/fit.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "check/guarantees/adaptation.hpp"
#include "check/guarantees/conformal.hpp"

namespace etlc::calibrate {

namespace {

using check::ThresholdOrigin;

/// true positives / (positives + found): half of F1, compared without rounding.
struct HalfF1 {
    std::uint64_t true_positives = 0;
    std::uint64_t of = 1;

    double value() const {
        return 2 * static_cast<double>(true_positives) / static_cast<double>(of);
    }
    /// Frames are fewer than 2^32 in any memory, so the products fit.
    bool operator<(const HalfF1& other) const {
        return true_positives * other.of < other.true_positives * of;
    }
};

/// The scores between which epsilon may lie and say the same of all frames: the one that was
/// taken, and of <= the next above it, of < the next below. Ascending; the one alone where there is
/// no finite other.
std::vector<float> gap(const std::vector<Scores::Labelled>& ascending, float taken, bool strict) {
    const auto [first, last] =
        std::equal_range(ascending.begin(), ascending.end(), Scores::Labelled{taken, false},
                         [](const auto& a, const auto& b) { return a.score < b.score; });
    if (!strict && last != ascending.end() && !std::isinf(last->score)) return {taken, last->score};
    if (strict && first != ascending.begin() && !std::isinf(std::prev(first)->score))
        return {std::prev(first)->score, taken};
    return {taken};
}

}  // namespace

void mirror(Fitted& fitted, bool upper_bound) {
    if (!upper_bound) {
        fitted.epsilon = 0.0F - fitted.epsilon;  // 0 rather than -0
        for (double& score : fitted.scores) score = 0.0 - score;
    }
    std::sort(fitted.scores.begin(), fitted.scores.end());
}

Fit fit_rank(std::vector<double> reaches, const std::string& alpha) {
    Fitted result;
    result.n = reaches.size();
    if (result.n == 0) return Refusal::no_positives;
    result.k = check::rank(alpha, result.n);
    if (result.k > result.n) return Refusal::too_few;
    const auto kth = reaches.begin() + static_cast<std::ptrdiff_t>(result.k - 1);
    std::nth_element(reaches.begin(), kth, reaches.end());
    if (std::isinf(*kth)) return Refusal::not_finite;
    result.epsilon = check::strictly_above(*kth);
    result.scores = {*kth};
    if (std::isinf(result.epsilon)) return Refusal::not_finite;
    return result;
}

Fit fit_f1(std::vector<Scores::Labelled> labelled, bool strict) {
    std::sort(labelled.begin(), labelled.end(),
              [](const auto& a, const auto& b) { return a.score < b.score; });
    const auto is_positive = [](const Scores::Labelled& frame) { return frame.positive; };
    const auto positives =
        static_cast<std::uint64_t>(std::count_if(labelled.begin(), labelled.end(), is_positive));
    if (positives == 0) return Refusal::no_positives;
    Fitted result;
    result.n = labelled.size();
    HalfF1 best;
    std::uint64_t true_positives = 0;
    for (std::size_t i = 0; i < labelled.size();) {
        const float epsilon = labelled[i].score;
        const std::size_t before = i;
        const std::uint64_t positives_before = true_positives;
        for (; i < labelled.size() && labelled[i].score == epsilon; ++i)
            true_positives += labelled[i].positive ? 1 : 0;
        if (std::isinf(epsilon)) continue;
        const HalfF1 here = strict ? HalfF1{positives_before, positives + before}
                                   : HalfF1{true_positives, positives + i};
        if (!(best < here)) continue;  // of equals the first is the strictest
        best = here;
        result.epsilon = epsilon;
        result.f1 = here.value();
    }
    if (best.true_positives == 0) return Refusal::no_f1;
    const std::vector<float> ends = gap(labelled, result.epsilon, strict);
    result.scores = {static_cast<double>(result.epsilon)};
    const auto between = ends.size() == 2 ? check::halfway(ends[0], ends[1]) : std::nullopt;
    if (!between) return result;
    result.epsilon = *between;
    result.scores.assign(ends.begin(), ends.end());
    return result;
}

Fit fit(const check::Predicate& predicate, const std::vector<Demonstration>& demonstrations,
        std::size_t of) {
    const bool is_f1 = predicate.threshold.origin == ThresholdOrigin::f1;
    std::vector<Scores::Labelled> labelled;
    std::vector<double> reaches;
    std::vector<double> by_episode;
    for (const Demonstration& demonstration : demonstrations) {
        const Scores& scores = demonstration.scores[of];
        if (is_f1) labelled.insert(labelled.end(), scores.labelled.begin(), scores.labelled.end());
        if (predicate.threshold.origin == ThresholdOrigin::class_conditional) {
            reaches.insert(reaches.end(), scores.reaches.begin(), scores.reaches.end());
        } else if (!is_f1 && scores.has_score) {
            reaches.push_back(scores.worst_reach);
            by_episode.push_back(scores.worst_reach);
        }
    }
    Fit fit = is_f1 ? fit_f1(std::move(labelled), predicate.strict())
                    : fit_rank(std::move(reaches), predicate.threshold.alpha);
    if (auto* fitted = std::get_if<Fitted>(&fit)) {
        if (!by_episode.empty()) fitted->scores = std::move(by_episode);
        mirror(*fitted, predicate.upper_bound());
        const auto& adaptation = predicate.threshold.adaptation;
        if (adaptation && !check::start(*adaptation, fitted->epsilon, predicate.upper_bound()))
            return OutOfRange{fitted->epsilon};
    }
    return fit;
}

}  // namespace etlc::calibrate
