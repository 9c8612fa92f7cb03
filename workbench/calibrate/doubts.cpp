// Errors where no threshold can be fitted, and warnings about those that are doubtful.
#include <fmt/format.h>

#include <cmath>

#include "calibrate/fit.hpp"
#include "check/guarantees/calibrated.hpp"
#include "check/guarantees/conformal.hpp"
#include "check/numbers/decimal.hpp"
#include "episodes/data_warnings.hpp"
#include "episodes/ranking/auroc.hpp"

namespace etlc::calibrate {

namespace {

/// Returns the share of the negative frames that the threshold takes for positive, or 0 without
/// any.
double false_part(const check::Predicate& predicate, const Evidence& evidence,
                  const Fitted& fitted) {
    const float epsilon = predicate.upper_bound() ? fitted.epsilon : -fitted.epsilon;
    std::uint64_t within = 0;
    evidence.labelled.for_each([&](const episodes::Scored& frame) {
        const bool holds = frame.score < epsilon || (!predicate.strict() && frame.score == epsilon);
        within += holds && !frame.positive ? 1 : 0;
    });
    const auto negatives = static_cast<double>(evidence.labelled.negatives());
    return negatives == 0 ? 0 : static_cast<double>(within) / negatives;
}

}  // namespace

void refuse_too_few(const check::Threshold& threshold, const TooFew& found, diag::Sink& sink) {
    auto& error =
        sink.report(diag::Code::too_few_scores, threshold.span,
                    fmt::format("alpha = {} needs at least {}{}; there {} {}", threshold.alpha,
                                diag::counted(check::scores_needed(threshold.alpha), found.noun),
                                found.which, found.scores == 1 ? "is" : "are", found.scores));
    if (!found.in_groups.empty())
        error.note(
            fmt::format("{} are in {}, and the episodes of a group count once, with the "
                        "worst of them",
                        found.in_groups, diag::counted(found.all, found.noun)));
    if (found.all <= found.scores) return;
    const std::uint64_t left_out = found.all - found.scores;
    error.note(fmt::format("of {}, {} without such a {} {} left out",
                           diag::counted(found.all, found.noun), left_out, found.unit,
                           left_out == 1 ? "is" : "are"));
}

void refuse_infinite(const std::string& name, const check::Threshold& threshold, const char* what,
                     diag::Sink& sink) {
    sink.report(diag::Code::no_threshold, threshold.span,
                fmt::format("the score of '{}' at the rank of alpha = {} is infinite: no {} lies "
                            "beyond it",
                            name, threshold.alpha, what));
}

void warn_of_large_alpha(const std::string& name, const check::Threshold& threshold,
                         diag::Sink& sink) {
    using check::Decimal;
    if (threshold.alpha.empty() || !(Decimal::parse("0.5") < Decimal::parse(threshold.alpha)))
        return;
    episodes::warn_of_data(
        diag::Code::large_alpha,
        fmt::format("alpha = {} of '{}' allows more than half to be missed", threshold.alpha, name),
        threshold.span, sink)
        .note(check::large_alpha_note(threshold.alpha));
}

void warn_of_doubts(const check::Predicate& predicate, const Evidence& evidence,
                    const Fitted& fitted, diag::Sink& sink) {
    constexpr double kNearlyEvery = 0.95;
    warn_of_large_alpha(predicate.name, predicate.threshold, sink);
    const auto warn = [&](std::string message) -> diag::Diagnostic& {
        return episodes::warn_of_data(diag::Code::doubtful_threshold, std::move(message),
                                      predicate.threshold.span, sink);
    };
    const auto ranked =
        episodes::auroc(evidence.labelled, evidence.groups, episodes::Likely::smaller);
    if (episodes::warn_of_labels(predicate, {evidence.positives, evidence.negatives}, ranked, sink))
        return;
    if (ranked && ranked->interval && ranked->interval->low <= 0.5) {
        warn(fmt::format("what '{}' measures does not tell its labels apart: the area under the "
                         "ROC curve is {:.2f}, with a 95 % interval from {:.2f} to {:.2f}",
                         predicate.name, ranked->value, ranked->interval->low,
                         ranked->interval->high))
            .note("0.5 is chance: check the labels, the embedding and the targets");
        return;
    }
    const double part = false_part(predicate, evidence, fitted);
    if (part < kNearlyEvery) return;
    warn(fmt::format("with the threshold {:.9g}, '{}' is true at {:.0f} % of the frames labelled "
                     "false",
                     fitted.epsilon, predicate.name, std::floor(100 * part)))
        .note("a weaker guarantee, more targets or other labels may make it narrower");
}

}  // namespace etlc::calibrate
