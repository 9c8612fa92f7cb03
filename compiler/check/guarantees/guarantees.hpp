// The guarantees of calibrated thresholds for the verdicts of a monitor: for its whole formula or
// for each conjunct. Robustness is monotonic in every literal of the negation normal form: if all
// calibrated predicates are positive and none misses its truth, no verdict misses a success of the
// ground-truth monitor; if all are negative, none misses an alarm. A union bound adds the alphas.
// There is no guarantee about a predicate without conformal calibration that is not its own truth.
// A robustness of 0 counts as satisfied even if the comparison is false; guarantees about
// violations mention this exception.
//
// A predicate against both errors has a bound on each, and says neither between its thresholds.
// While every frame keeps its bounds, the truth of a predicate lies in its value, so by induction
// over min, max and negation that of a verdict lies in the verdict, for a formula of any polarity:
// it is satisfied wrongly only if a plain predicate is called true wrongly or a negated one false,
// and violated wrongly the other way round.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "check/model/model.hpp"

namespace etlc::check {

struct Guarantee {
    enum class Kind : std::uint8_t {
        nothing,
        exact,           ///< nothing is calibrated, and every predicate is its own truth
        missed_success,  ///< P(some verdict of a new episode misses a success) <= bound
        missed_alarm,    ///< P(some verdict of a new episode misses an alarm) <= bound
        /// P(some verdict of a new episode is violated for good) <= bound. Of `normal` thresholds:
        /// while its truth, in which these predicates always hold, is not.
        false_alarm,
        // where predicates or the monitor are calibrated against both errors; unknown is neither
        satisfied_wrongly,  ///< P(some verdict is satisfied while its truth is violated) <= bound
        violated_wrongly,   ///< P(some verdict is violated while its truth is satisfied) <= bound
        wrong,              ///< P(one or the other) <= bound
        // of a monitor calibrated by risk
        satisfied_share,  ///< E(share of the truly violated steps that are satisfied) <= bound
        violated_share,   ///< E(share of the truly satisfied steps that are violated) <= bound
    };
    Kind kind = Kind::nothing;
    std::string part;      ///< the conjunct as canonical text; empty for the whole formula
    Index formula = 0;     ///< the conjunct or the whole formula
    bool negated = false;  ///< the conjunct is the negation of `formula`
    std::string bound;     ///< exact decimal sum of the alphas
    /// The least number of groups of episodes that a threshold was calibrated on; 0: of none that
    /// has groups, whose demonstrations count one by one.
    std::uint64_t groups = 0;
    bool normal = false;  ///< of new normal episodes: some threshold is `calibrated(normal, ...)`
    std::string why;      ///< the reason for `nothing`
    /// For exact, missed_alarm, satisfied_wrongly and wrong: a comparison that is its own truth is
    /// false at its threshold, where robustness is 0.
    bool zero_aside = false;
};

/// Returns the guarantees of a monitor calibrated as a whole; otherwise that of its calibrated
/// duration, if it has one, and the guarantees about the whole formula (up to three where
/// predicates are calibrated against both errors) and, if that is `nothing`, about its conjuncts.
/// `values` are those that the monitor computes with; truths are decided by the comparisons
/// themselves.
std::vector<Guarantee> guarantees(const Model& model, const Monitor& monitor,
                                  Values values = Values::robustness);

/// Returns the guarantee in words: "P(some verdict of a new episode misses a success) <= 0.1"; that
/// of a conjunct after "part F a: ".
std::string text(const Guarantee& guarantee);

/// Returns "37 of 40", the rank of a conformal threshold, or "4 of 4 groups"; "none of 3" if the
/// scores are too few and the threshold is infinite. `inner`: of the one against false positives.
std::string place(const Threshold& threshold, bool inner = false);

/// Returns the thresholds: "0.35", or "0.27 to 0.35" if there are two.
std::string numbers(const Threshold& threshold);

/// Describes the origin of a threshold and its own guarantee: "calibrated for F1; no guarantee".
std::string origin(const Threshold& threshold);

/// Describes what is subtracted from the robustness of a monitor that is calibrated as a whole.
std::string of_shift(const Threshold& shift);

/// Returns the bound on the misses of an adaptive predicate among the first T labelled positive
/// frames, "0.1 T + 35.7 + 0.9 H", where H is the number of misses at which the end of its range
/// held the threshold back. docs/calibration.md derives it.
std::string miss_bound(const Predicate& predicate);

/// Explains "except at robustness 0" to readers of guarantees.
inline constexpr std::string_view kZeroAside =
    "Robustness 0 counts as satisfied, even if a comparison that is its own truth is false there.";

/// Explains bounds on missed successes to readers of guarantees.
inline constexpr std::string_view kMissingAside =
    "Bounds on successes exclude steps with missing samples.";

/// Explains probabilities to readers of guarantees. `by_group`: groups of episodes count.
std::string exchangeability(bool by_group);

/// Describes a duration after calibration: "within 54 steps (1.8 s), from 120 demonstrations; score
/// 115 of 120, coverage 0.911 to 0.986".
std::string of_duration(const Model& model, const Duration& duration);

/// Visits every part of the formula in its negation normal form, once for each polarity.
void for_each_literal(const Model& model, Index formula,
                      const std::function<void(Index part, bool negated)>& visit);

/// Whether the comparison itself is the truth: a predicate over scalars and numbers only, without a
/// `truth`.
bool is_own_truth(const Model& model, Index predicate);

/// Returns quantiles of Beta(k, n + 1 - k), the distribution of the coverage that n scores without
/// ties give at rank k (Vovk, "Conditional validity of inductive conformal predictors", 2012). k in
/// [1, n], q in (0, 1).
double coverage_quantile(std::uint64_t n, std::uint64_t k, double q);

}  // namespace etlc::check
