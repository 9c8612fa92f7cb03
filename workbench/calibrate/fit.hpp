// Computes thresholds from scores, by the definitions "F1-Optimal Threshold" and "Conformal
// Calibration Threshold" (Kapoor et al.), mirrored for >= and >. The rank is never clamped: too few
// demonstrations are an error.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "artifacts/thresholds.hpp"
#include "calibrate/scores.hpp"
#include "check/guarantees/provenance.hpp"
#include "diag/diag.hpp"
#include "episodes/folds.hpp"
#include "episodes/recording.hpp"

namespace etlc::calibrate {

struct Fitted {
    float epsilon = 0;    ///< for an adaptive threshold: before rounding to its grid
    std::uint64_t n = 0;  ///< number of scores: groups of demonstrations (conformal) or frames
    std::uint64_t k = 0;  ///< rank taken; 0 for f1
    /// Conformal: all scores, as far out as any build may measure them, ascending.
    /// Class-conditional: the score taken. F1: the score taken, and the next if epsilon is halfway
    /// between the two.
    std::vector<double> scores;
    double f1 = 0;  ///< f1: the F1 of epsilon on the frames that it was chosen on
};

/// Reasons why there is no threshold, in the order in which they are checked.
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

/// Whether a group counts.
using Counts = std::function<bool(std::uint32_t group)>;
inline constexpr auto kAll = [](std::uint32_t) { return true; };

Fit fit(const check::Predicate& predicate, const Evidence& evidence, const Counts& counts = kAll);

/// Returns an entry of the thresholds file.
thresholds::Entry entry_of(const check::Threshold& threshold, const Fitted& fitted,
                           check::Reads reads);

/// Describes the place of a threshold: "just above the 19th smallest of 20 scores, one per
/// demonstration", where `each` is a demonstration. Lower bounds lie below the greatest scores.
std::string describe_place(const Fitted& fitted, bool upper_bound, const std::string& each);

/// Restores the sign of a threshold and its scores, which are negated for >= and > so that smaller
/// ones are better, and sorts the scores.
void mirror(Fitted& fitted, bool upper_bound);

/// Returns the first float32 strictly above the k-th smallest score, where k is the rank of alpha.
Fit fit_rank(std::vector<double> reaches, const std::string& alpha);

/// Finds the score that has the greatest F1 as epsilon in `score <= epsilon` (< if `strict`), over
/// the labelled frames of the groups that count; ties go to the least. Then moves epsilon
/// halfway to the next score, which changes the claim for none of these frames.
Fit fit_f1(const episodes::FramesByScore& labelled, bool strict, const Counts& counts = kAll);

/// Does so without each part of the groups, in two passes over the frames; `part_of`: per group.
std::vector<Fit> fit_f1_without(const episodes::FramesByScore& labelled, bool strict,
                                const std::vector<std::uint32_t>& part_of, std::uint32_t parts);

/// A number of scores that is too small for alpha.
struct TooFew {
    std::uint64_t scores = 0;
    std::string noun;         ///< what gives a score: "demonstration"
    std::string which{};      ///< " in which 'p' is true at some frame"
    std::string unit{};       ///< "frame" or "step", missing in those left out
    std::uint64_t all = 0;    ///< scores and those left out; 0: none was left out
    std::string in_groups{};  ///< "40 demonstrations"; empty: they have no groups
};
void refuse_too_few(const check::Threshold& threshold, const TooFew& found, diag::Sink& sink);
/// Reports that no threshold or shift (`what`) lies beyond an infinite score.
void refuse_infinite(const std::string& name, const check::Threshold& threshold, const char* what,
                     diag::Sink& sink);

/// Warns about alpha > 0.5 of the predicate or monitor `name`.
void warn_of_large_alpha(const std::string& name, const check::Threshold& threshold,
                         diag::Sink& sink);

/// Warns about doubtful labels, a distance that does not tell them apart, a threshold so wide that
/// nearly every frame is within, and a large alpha. Silent where too few episodes leave it open.
void warn_of_doubts(const check::Predicate& predicate, const Evidence& evidence,
                    const Fitted& fitted, diag::Sink& sink);

// ---- without each group -------------------------------------------------------------------------
// The thresholds that all groups of episodes but one give, for each group, by the rule of the whole
// calibration; an episode without a group is one by itself. At most two scores can be at the rank
// of a conformal threshold when one of them is left out, so few thresholds are computed however
// many groups there are.

/// More groups than this are left out of an f1 threshold in as many parts: its best score is no
/// order statistic.
inline constexpr std::uint32_t kMostParts = 64;

struct LeftOut {
    std::vector<float> thresholds;  ///< per group; empty if one of them is missing
    std::string why;                ///< why one is missing: "no finite threshold is left"
    std::uint32_t parts = 0;        ///< f1: number of parts, if fewer than groups
};

/// Returns the thresholds of a predicate without each group of demonstrations.
LeftOut left_out(const check::Predicate& predicate, const Evidence& evidence,
                 const episodes::Identities& demonstrations, const episodes::Groups& groups);

/// Returns the shifts of a monitor that is calibrated as a whole without each group. `worst`: the
/// score of each group that has one.
LeftOut left_out(const check::MonitorCalibration& calibration,
                 const std::vector<Evidence::Reach>& worst, std::size_t groups);

}  // namespace etlc::calibrate
