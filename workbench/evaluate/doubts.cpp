// Warnings about the labels and thresholds behind an evaluation.
#include <fmt/format.h>

#include <algorithm>

#include "episodes/label_doubts.hpp"
#include "evaluate/evaluate.hpp"

namespace etlc::evaluate {

namespace {

/// Fewer episodes give no reliable interval.
constexpr std::uint64_t kFewEpisodes = 5;

/// Warns where both labels occur and nearly no resample has a gain. Only predicates: a monitor that
/// must not miss an alarm raises many on purpose.
void warn_of_no_gain(const std::string& name, const Score& score, source::Span span,
                     diag::Sink& sink) {
    const bool both = score.counts.positives() > 0 && score.counts.negatives() > 0;
    if (!both || !score.gain.interval || score.gain.interval->high > 0) return;
    episodes::warn_of_data(
        diag::Code::no_better_than_true,
        fmt::format("'{}' has an F1 of {:.3f}, no better than the {:.3f} of saying true at every "
                    "frame",
                    name, *score.f1.value, *score.f1.value - *score.gain.value),
        span, sink)
        .note("check the threshold, which may be too wide, the targets and the labels");
}

}  // namespace

void warn_of_doubts(const check::Model& model, const Evaluation& evaluation, diag::Sink& sink) {
    const bool enough = evaluation.episodes >= kFewEpisodes;
    for (const PredicateScore& score : evaluation.predicates) {
        const auto predicate =
            std::find_if(model.predicates.begin(), model.predicates.end(),
                         [&](const check::Predicate& one) { return one.name == score.name; });
        if (predicate == model.predicates.end()) continue;
        std::optional<episodes::Auroc> auroc;
        if (enough && score.auroc.value && score.auroc.interval)
            auroc = {*score.auroc.value, episodes::Auroc::Interval{score.auroc.interval->low,
                                                                   score.auroc.interval->high}};
        const Counts& counts = score.frames.counts;
        if (!episodes::warn_of_labels(*predicate, {counts.positives(), counts.negatives()}, auroc,
                                      sink) &&
            enough)
            warn_of_no_gain(score.name, score.frames, predicate->threshold.span, sink);
    }
}

}  // namespace etlc::evaluate
