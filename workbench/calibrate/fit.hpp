// Computes thresholds from scores, by the definitions "F1-Optimal Threshold" and "Conformal
// Calibration Threshold" (Kapoor et al.), mirrored for >= and >, and by conformal risk control
// (Angelopoulos et al.). The rank is never clamped: too few demonstrations are an error, or against
// both errors an infinite threshold. A monitor that is calibrated as a whole is a predicate over
// its robustness.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "artifacts/thresholds.hpp"
#include "calibrate/scores.hpp"
#include "check/guarantees/conformal.hpp"
#include "check/guarantees/provenance.hpp"
#include "diag/diag.hpp"
#include "episodes/folds.hpp"
#include "episodes/recording.hpp"

namespace etlc::calibrate {

/// One of the errors that a threshold is against.
struct Aim {
    bool of_positives = true;  ///< misses, or missed successes
    bool above = true;         ///< its threshold lies above the scores; see check::is_above
    std::string rate;
    std::string rate_name;  ///< "alpha"
};

/// Returns the errors that the threshold of a predicate is against: that of Threshold::value, and
/// against both errors that of Threshold::inner.
std::vector<Aim> aims_of(const check::Predicate& predicate);

/// Returns a predicate over the robustness of a monitor, whose threshold is the shift.
check::Predicate over_robustness(const check::Monitor& monitor);

/// The threshold for one error; an adaptive one before rounding to its grid. Scores are as far out
/// as any build may measure them, ascending.
struct Fitted : thresholds::Side {
    double f1 = 0;  ///< f1: the F1 of epsilon on the frames that it was chosen on
};

/// Reasons why there is no threshold, in the order in which they are checked.
enum class Refusal : std::uint8_t {
    no_positives,  ///< no frame at which the error can happen has a known distance
    too_few,       ///< the rank is beyond the scores
    not_finite,    ///< the score at the rank is infinite, or no float32 lies beyond it
    no_f1,         ///< no observed distance as threshold finds a positive frame
    always_lost,   ///< missing samples alone lose more than alpha
};

/// An adaptive threshold that would start outside [lo, hi].
struct OutOfRange {
    float epsilon = 0;
};

using Fit = std::variant<Fitted, Refusal, OutOfRange>;

/// Whether a group counts.
using Counts = std::function<bool(std::uint32_t group)>;
inline constexpr auto kAll = [](std::uint32_t) { return true; };

/// The thresholds of a predicate, one for each of aims_of().
using Sides = std::vector<Fitted>;

/// Returns the threshold for one of its errors.
Fit fit(const check::Predicate& predicate, const Aim& aim, const Evidence& evidence,
        const Counts& counts = kAll);

/// Returns the thresholds that the predicate works with.
check::Both joined(const check::Predicate& predicate, const Sides& sides);
/// Sets them with their numbers of scores.
void set(check::Threshold& threshold, const check::Predicate& predicate, const Sides& sides);

/// Returns the loss of each group that counts, where scores above `lambda` are lost.
std::vector<double> losses_beyond(const Evidence::Side& side, double lambda, const Counts& counts);

/// Returns an entry of the thresholds file.
thresholds::Entry entry_of(const check::Threshold& threshold, const Sides& sides,
                           check::Reads reads);

/// Describes the place of a threshold: "just above the 19th smallest of 20 scores, one per
/// demonstration", where `each` is a demonstration. Lower bounds lie below the greatest scores.
std::string describe_place(const Fitted& fitted, bool above, const std::string& each);

/// Restores the sign of a threshold and its scores, which are negated where it lies below them so
/// that smaller ones are better, and sorts the scores.
void mirror(Fitted& fitted, bool above);

/// Returns the first float32 strictly above the k-th smallest score, where k is the rank of alpha.
Fit fit_rank(std::vector<double> reaches, const std::string& alpha);

/// Finds the score that has the greatest F1 as epsilon in `score <= epsilon` (< if `strict`), over
/// the labelled frames of the groups that count; ties go to the least. Then moves epsilon
/// halfway to the next score, which changes the prediction for none of these frames.
Fit fit_f1(const episodes::FramesByScore& labelled, bool strict, const Counts& counts = kAll);

/// Does so without each part of the groups, in two passes over the frames; `part_of`: per group.
std::vector<Fit> fit_f1_without(const episodes::FramesByScore& labelled, bool strict,
                                const std::vector<std::uint32_t>& part_of, std::uint32_t parts);

/// A predicate, or a monitor as one, with what its threshold is computed from.
struct Subject {
    const check::Predicate& predicate;
    const Evidence& evidence;
    bool is_monitor = false;
    bool by_group = false;

    /// Returns "demonstration" or "group".
    const char* noun() const {
        return by_group ? "group" : is_monitor ? "episode" : "demonstration";
    }
    /// Returns "frame" or "step".
    const char* unit() const { return is_monitor ? "step" : "frame"; }
    /// Returns " in which 'p' is true at some frame".
    std::string which(const Aim& aim) const;
};
/// Reports why a predicate, or a monitor as one, has no threshold for an error.
void refuse(const check::Model& model, const Subject& of, const Aim& aim, Refusal refusal,
            diag::Sink& sink);
/// Reports that both thresholds are infinite.
void refuse_both(const Subject& of, diag::Sink& sink);

/// Warns about rates > 0.5 of a predicate, or a monitor as one.
void warn_of_large_alpha(const check::Predicate& predicate, diag::Sink& sink);

/// Warns about doubtful labels, a distance that does not tell them apart, a threshold so wide that
/// nearly every frame is within, and a large alpha. Silent where too few episodes leave it open.
void warn_of_doubts(const check::Predicate& predicate, const Evidence& evidence, float epsilon,
                    diag::Sink& sink);

// ---- without each group -------------------------------------------------------------------------
// The thresholds that all groups of episodes but one give, for each group, by the rule of the whole
// calibration; an episode without a group is one by itself. At most two scores can be at the rank
// of a conformal threshold when one of them is left out, so few thresholds are computed however
// many groups there are.

/// More groups than this are left out of a threshold by f1 or risk in as many parts: its score is
/// no order statistic.
inline constexpr std::uint32_t kMostParts = 64;

struct LeftOut {
    std::vector<check::Both> thresholds;  ///< per group; empty if one of them is missing
    std::string why;                      ///< why one is missing: "no finite threshold is left"
    std::uint32_t parts = 0;              ///< f1, risk: number of parts, if fewer than groups
};

/// Returns the thresholds of a predicate, or a monitor as one, without each group of
/// demonstrations.
LeftOut left_out(const check::Predicate& predicate, const Evidence& evidence,
                 const episodes::Identities& demonstrations, const episodes::Groups& groups);

}  // namespace etlc::calibrate
