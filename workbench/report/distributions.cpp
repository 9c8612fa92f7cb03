#include "report/distributions.hpp"

#include <algorithm>
#include <cmath>

namespace etlc::report {

namespace {

constexpr std::size_t kBins = 60;
constexpr double kPicture = 256;  ///< parts of a side of the curves' picture

using episodes::Scored;

/// The greatest scores first.
std::vector<Scored> finite_frames(const evaluate::Judgement& judgement, std::size_t i) {
    std::vector<Scored> frames;
    for (const episodes::FramesByScore& fold : judgement.predicates[i].frames)
        fold.for_each([&](const Scored& frame) {
            if (std::isfinite(frame.score)) frames.push_back(frame);
        });
    std::stable_sort(frames.begin(), frames.end(),
                     [](const Scored& a, const Scored& b) { return a.score > b.score; });
    return frames;
}

void count(const std::vector<Scored>& frames, bool upper_bound, Distribution& result) {
    const auto distance = [&](const Scored& frame) {
        return static_cast<double>(upper_bound ? -frame.score : frame.score);
    };
    const auto [first, last] = std::minmax({distance(frames.front()), distance(frames.back())});
    const double width = last > first ? (last - first) / kBins : 1;
    for (std::size_t bin = 0; bin <= kBins; ++bin)
        result.edges.push_back(first + width * static_cast<double>(bin));
    result.inside.resize(kBins);
    result.outside.resize(kBins);
    for (const Scored& frame : frames) {
        const auto bin = static_cast<std::size_t>((distance(frame) - first) / width);
        ++(frame.positive ? result.inside : result.outside)[std::min(bin, kBins - 1)];
    }
}

bool is_drawn_apart(const Operating& a, const Operating& b) {
    const auto apart = [](double x, double y) {
        return std::lround(x * kPicture) != std::lround(y * kPicture);
    };
    return apart(a.false_positive_rate, b.false_positive_rate) || apart(a.recall, b.recall) ||
           apart(a.precision, b.precision);
}

}  // namespace

std::optional<Distribution> distribution(const evaluate::Judgement& judgement, std::size_t i,
                                         const check::Predicate& predicate) {
    if (predicate.equality()) return std::nullopt;
    const std::vector<Scored> frames = finite_frames(judgement, i);
    if (frames.empty()) return std::nullopt;
    Distribution result;
    count(frames, predicate.upper_bound(), result);
    const auto positives = static_cast<double>(
        std::count_if(frames.begin(), frames.end(), [](const Scored& f) { return f.positive; }));
    const double negatives = static_cast<double>(frames.size()) - positives;
    if (positives == 0 || negatives == 0) return result;
    double hits = 0;
    double false_alarms = 0;
    const auto here = [&] {
        const double claims = hits + false_alarms;
        return Operating{false_alarms / negatives, hits / positives,
                         claims == 0 ? 1 : hits / claims};
    };
    result.curve.push_back(here());
    result.operating = here();
    for (std::size_t k = 0; k < frames.size(); ++k) {
        (frames[k].positive ? hits : false_alarms) += 1;
        const float score = frames[k].score;
        if (k + 1 < frames.size() && frames[k + 1].score == score) continue;
        const bool is_last = k + 1 == frames.size();
        if (is_last || is_drawn_apart(result.curve.back(), here())) result.curve.push_back(here());
        const float delta = predicate.upper_bound() ? -score : score;
        if (check::holds(predicate.comparison, delta, predicate.threshold.value))
            result.operating = here();
    }
    return result;
}

}  // namespace etlc::report
