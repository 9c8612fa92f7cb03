// From scores to thresholds.
// Takes: what demonstrations say of a predicate. Gives: epsilon, or why there is none.
// Keeps true: Definitions "F1-Optimal Threshold" and "Conformal Calibration Threshold" (Kapoor et
// al.), mirrored for >= and >; what an F1-optimal threshold says of the frames that it is from is
// what the definition's says; the rank is never clamped: too few demonstrations are an error.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "calibrate/evidence.hpp"

namespace etlc::calibrate {

struct Fitted {
    float epsilon = 0;    ///< of an adaptive threshold: before it is put on its grid
    std::uint64_t n = 0;  ///< scores: demonstrations (conformal) or frames
    std::uint64_t k = 0;  ///< rank taken; 0 for f1
    /// Conformal: all, as far out as any build may measure them, ascending. Class-conditional: the
    /// one taken. F1: that one and the next, where epsilon is halfway between them.
    std::vector<double> scores;
    double f1 = 0;  ///< f1: what epsilon reaches on the frames that it was chosen on
};

/// Why no threshold can be had, in the order in which it is looked for.
enum class Refusal : std::uint8_t {
    no_positives,  ///< no frame with a known distance is positive
    too_few,       ///< the rank is beyond the scores
    not_finite,    ///< the score at the rank is infinite, or no float32 lies beyond it
    no_f1,         ///< no observed distance as threshold finds a positive frame
};

/// An adaptive threshold that would start outside [lo, hi].
struct OutOfRange {
    float epsilon = 0;
};

using Fit = std::variant<Fitted, Refusal, OutOfRange>;

/// Whether a demonstration counts.
using Counts = std::function<bool(std::uint32_t demonstration)>;
inline constexpr auto kAll = [](std::uint32_t) { return true; };

Fit fit(const check::Predicate& predicate, const Evidence& evidence, const Counts& counts = kAll);

/// From scores of which a smaller one is always better, to thresholds and scores as they are
/// compared: those of >= and > change their sign. Scores are ascending after it.
void mirror(Fitted& fitted, bool upper_bound);

/// The first float32 strictly beyond the k-th smallest, k the rank of alpha.
Fit fit_rank(std::vector<double> reaches, const std::string& alpha);

/// Epsilon such that `score <= epsilon`, or < where `strict`, has the greatest F1 that a score as
/// epsilon has; of equals it is the least. From that score it is moved halfway to the next that
/// says another thing, where there is one: of these frames that says the same. Of all labelled
/// frames of the demonstrations that count.
Fit fit_f1(const episodes::FramesByScore& labelled, bool strict, const Counts& counts = kAll);

}  // namespace etlc::calibrate
