// Doubts about the labels of a predicate.
// Takes: how many frames they call positive and negative, and the area under the ROC curve of what
// the predicate measures. Gives: a warning where they are all alike, or the wrong way round. Keeps
// true: the same wherever labels are read; a direction is doubted where the whole interval says so.
#pragma once

#include <cstdint>
#include <optional>

#include "check/model/model.hpp"
#include "diag/diag.hpp"
#include "episodes/ranking/auroc.hpp"

namespace etlc::episodes {

struct Labels {
    std::uint64_t positives = 0;
    std::uint64_t negatives = 0;
};

/// Whether there was something to warn of.
bool warn_of_labels(const check::Predicate& predicate, Labels labels,
                    const std::optional<Auroc>& auroc, diag::Sink& sink);

/// A warning of the data that is about a place in the spec, of which nothing is wrong.
diag::Diagnostic& warn_of_data(diag::Code code, std::string message, source::Span about,
                               diag::Sink& sink);

}  // namespace etlc::episodes
