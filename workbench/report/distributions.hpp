// How a predicate's distance tells the two truths apart, as the page draws it.
// Takes: the labelled frames of an evaluation. Gives: counts of distances inside and outside, the
// ROC and the precision-recall curve, and where the threshold stands on them. Keeps true: curves go
// through every threshold, and are then thinned to what a picture shows; frames whose distance is
// unknown are in none of them.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "evaluate/evaluate.hpp"

namespace etlc::report {

/// Rates at one threshold.
struct Operating {
    double false_positive_rate = 0;
    double recall = 0;     ///< the true positive rate
    double precision = 1;  ///< of no claim at all
};

struct Distribution {
    std::vector<double> edges;          ///< of the bins, one more than these
    std::vector<std::uint64_t> inside;  ///< frames at which the truth holds
    std::vector<std::uint64_t> outside;
    std::vector<Operating> curve;        ///< from the strictest threshold to the widest
    std::optional<Operating> operating;  ///< of the predicate's own threshold
};

/// Of the i-th labelled predicate. Nothing of one whose comparison is an equality, and where no
/// labelled frame has a finite distance.
std::optional<Distribution> distribution(const evaluate::Judgement& judgement, std::size_t i,
                                         const check::Predicate& predicate);

}  // namespace etlc::report
