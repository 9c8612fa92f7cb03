#include "calibrate/doubts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "data/files/file.hpp"

namespace etlc::calibrate {

namespace {

struct Frame {
    float score = 0;  ///< the smaller, the more likely positive
    bool positive = false;
    std::size_t episode = 0;
};

/// Pairs of a positive and a negative frame that are ordered as they should be, a tie being half a
/// pair; of an episode those that it has a part in.
struct Pairs {
    double ordered = 0;
    double within = 0;  ///< of these, both frames are of the episode
    double positives = 0;
    double negatives = 0;
};

/// Calls `visit(frame, ordered)` for each frame, with how many pairs it is in that are ordered.
template <class Visit>
void for_each_in_order(std::vector<Frame>& frames, const Visit& visit) {
    std::sort(frames.begin(), frames.end(),
              [](const Frame& a, const Frame& b) { return a.score < b.score; });
    double negatives_left = static_cast<double>(std::count_if(
        frames.begin(), frames.end(), [](const Frame& frame) { return !frame.positive; }));
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

struct Auroc {
    double value = 0;
    double low = 0;  ///< of a 95 % interval by leaving out one episode at a time (jackknife)
    double high = 0;
};

/// Nothing where there are too few episodes for an interval, or only frames of one kind.
std::optional<Auroc> auroc(const std::vector<Demonstration>& demonstrations, std::size_t of) {
    constexpr std::size_t kLeastEpisodes = 5;
    std::vector<Frame> frames;
    std::vector<Pairs> episodes(demonstrations.size());
    Pairs all;
    for (std::size_t e = 0; e < demonstrations.size(); ++e) {
        std::vector<Frame> own;
        for (const Scores::Labelled& frame : demonstrations[e].scores[of].labelled) {
            own.push_back({frame.score, frame.positive, e});
            ++(frame.positive ? episodes[e].positives : episodes[e].negatives);
        }
        for_each_in_order(own, [&](const Frame& frame, double ordered) {
            if (frame.positive) episodes[e].within += ordered;
        });
        all.positives += episodes[e].positives;
        all.negatives += episodes[e].negatives;
        frames.insert(frames.end(), own.begin(), own.end());
    }
    for_each_in_order(frames, [&](const Frame& frame, double ordered) {
        episodes[frame.episode].ordered += ordered;
        if (frame.positive) all.ordered += ordered;
    });

    std::vector<double> without_one;
    for (const Pairs& own : episodes) {
        const double pairs = (all.positives - own.positives) * (all.negatives - own.negatives);
        if (pairs > 0 && own.positives + own.negatives > 0)
            without_one.push_back((all.ordered - own.ordered + own.within) / pairs);
    }
    if (without_one.size() < kLeastEpisodes) return std::nullopt;
    const auto n = static_cast<double>(without_one.size());
    double mean = 0;
    for (const double value : without_one) mean += value / n;
    double squares = 0;
    for (const double value : without_one) squares += (value - mean) * (value - mean);
    const double margin = 1.96 * std::sqrt((n - 1) / n * squares);
    const double value = all.ordered / (all.positives * all.negatives);
    return Auroc{value, std::max(0.0, value - margin), std::min(1.0, value + margin)};
}

/// Which part of the negative frames the threshold takes for positive; 0 where there are none.
double false_part(const check::Predicate& predicate,
                  const std::vector<Demonstration>& demonstrations, std::size_t of,
                  const Fitted& fitted) {
    const float epsilon = predicate.upper_bound() ? fitted.epsilon : -fitted.epsilon;
    std::uint64_t negatives = 0;
    std::uint64_t within = 0;
    for (const Demonstration& demonstration : demonstrations)
        for (const Scores::Labelled& frame : demonstration.scores[of].labelled) {
            if (frame.positive) continue;
            ++negatives;
            within += frame.score < epsilon || (!predicate.strict() && frame.score == epsilon);
        }
    return negatives == 0 ? 0 : static_cast<double>(within) / static_cast<double>(negatives);
}

}  // namespace

void warn_of_doubts(const check::Predicate& predicate,
                    const std::vector<Demonstration>& demonstrations, std::size_t of,
                    const Fitted& fitted, diag::Sink& sink) {
    constexpr double kNearlyEvery = 0.95;
    const auto warn = [&](std::string message) -> diag::Diagnostic& {
        // Of the data: of the spec nothing is wrong.
        diag::Diagnostic found =
            data::in_file({diag::Code::doubtful_threshold, std::move(message)}, "--data");
        found.span = predicate.threshold.span;
        return sink.report(std::move(found));
    };
    const auto ranked = auroc(demonstrations, of);
    if (ranked && ranked->low <= 0.5) {
        warn(fmt::format("what '{}' measures does not tell its labels apart: the area under the "
                         "ROC curve is {:.2f}, with a 95 % interval from {:.2f} to {:.2f}",
                         predicate.name, ranked->value, ranked->low, ranked->high))
            .note(ranked->high < 0.5
                      ? "0.5 is chance, and less says that the comparison is the wrong way round"
                      : "0.5 is chance: look at the labels, the embedding and the targets");
        return;
    }
    const double part = false_part(predicate, demonstrations, of, fitted);
    if (part < kNearlyEvery) return;
    warn(fmt::format("with the threshold {:.9g} '{}' is true of {:.0f} % of the frames of which it "
                     "should be false",
                     fitted.epsilon, predicate.name, std::floor(100 * part)))
        .note("a weaker guarantee, more targets or other labels make it say more");
}

}  // namespace etlc::calibrate
