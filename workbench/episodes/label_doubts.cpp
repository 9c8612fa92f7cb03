#include "episodes/label_doubts.hpp"

#include <fmt/format.h>

#include "data/files/file.hpp"

namespace etlc::episodes {

diag::Diagnostic& warn_of_data(diag::Code code, std::string message, source::Span about,
                               diag::Sink& sink) {
    diag::Diagnostic found = data::in_file({code, std::move(message)}, "--data");
    found.span = about;
    return sink.report(std::move(found));
}

bool warn_of_labels(const check::Predicate& predicate, Labels labels,
                    const std::optional<Auroc>& auroc, diag::Sink& sink) {
    const std::uint64_t all = labels.positives + labels.negatives;
    const source::Span span = predicate.threshold.span;
    if (all > 0 && (labels.positives == 0 || labels.negatives == 0)) {
        const bool holds = labels.negatives == 0;
        warn_of_data(diag::Code::one_sided_labels,
                     fmt::format("'{}' is {} at all {}", predicate.name, holds ? "true" : "false",
                                 diag::counted(all, "labelled frame")),
                     span, sink)
            .note(fmt::format("these say nothing about frames at which it is {}: look at its truth "
                              "or the array truth.{}, or record such frames too",
                              holds ? "false" : "true", predicate.name));
        return true;
    }
    if (!auroc || !auroc->interval || auroc->interval->high >= 0.5) return false;
    warn_of_data(
        diag::Code::inverted_labels,
        fmt::format("the labels of '{}' are the wrong way round for what it measures: the "
                    "area under the ROC curve is {:.2f}, with a 95 % interval from {:.2f} "
                    "to {:.2f}",
                    predicate.name, auroc->value, auroc->interval->low, auroc->interval->high),
        span, sink)
        .note(fmt::format("below 0.5, {} numbers are labelled true: look at its truth or the array "
                          "truth.{}, and at the comparison",
                          predicate.upper_bound() ? "the greater" : "the smaller", predicate.name));
    return true;
}

}  // namespace etlc::episodes
