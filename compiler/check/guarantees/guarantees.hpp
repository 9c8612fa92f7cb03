// What calibrated thresholds guarantee about a monitor's verdicts.
// Takes: the model. Gives: per monitor a claim, for the whole or for each conjunct. Keeps true:
// robustness is monotonic in every literal of the negation normal form, so where all calibrated
// predicates are positive and none misses its truth, no verdict misses a success of the
// ground-truth monitor; where all are negative, none misses an alarm. A union bound adds the
// alphas. Nothing is claimed about a predicate that no conformal calibration covers and that is not
// its own truth. A robustness of 0 counts as satisfied, also where the comparison says no: what a
// claim about violations does not cover for that, it says.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "check/model/model.hpp"

namespace etlc::check {

struct Claim {
    enum class Kind : std::uint8_t {
        nothing,
        exact,           ///< nothing is calibrated, and every predicate is its own truth
        missed_success,  ///< P(some verdict of a new episode misses a success) <= bound
        missed_alarm,    ///< P(some verdict of a new episode misses an alarm) <= bound
    };
    Kind kind = Kind::nothing;
    std::string part;   ///< the conjunct as canonical text; empty: the whole formula
    std::string bound;  ///< exact decimal sum of the alphas
    std::string why;    ///< nothing: what is in the way
    /// exact, missed_alarm: a comparison that is its own truth says no at its threshold, where its
    /// robustness is 0.
    bool zero_aside = false;
};

/// Of a monitor that is calibrated as a whole, what that guarantees; else the claim about the whole
/// and, where that is nothing, about its conjuncts. `values`: what the monitor computes with;
/// truths decide by the comparison itself.
std::vector<Claim> claims(const Model& model, const Monitor& monitor,
                          Values values = Values::robustness);

/// In words: "P(some verdict of a new episode misses a success) <= 0.1", "nothing: 'p' is
/// f1-calibrated".
std::string text(const Claim& claim);

/// Where a threshold comes from, and what that alone guarantees: "calibrated for F1; no guarantee".
std::string origin(const Threshold& threshold);

/// Of an adaptive predicate, how many of the first T labelled positive frames it misses at most,
/// "0.1 T + 35.7 + 0.9 H", H the number of misses at which the end of its range held the threshold
/// back. docs/calibration.md derives it.
std::string miss_bound(const Predicate& predicate);

/// What "robustness 0 aside" means, for those who read the claims.
inline constexpr std::string_view kZeroAside =
    "Robustness 0 counts as satisfied, also where a comparison that is its own truth says no.";

/// A predicate on scalars and numbers alone that has no `truth`: what its comparison says is what
/// is meant.
bool is_own_truth(const Model& model, Index predicate);

/// Quantiles of Beta(k, n + 1 - k), the distribution of the coverage that n scores without ties
/// give at rank k (Vovk, "Conditional validity of inductive conformal predictors", 2012). k in [1,
/// n], q in (0, 1).
double coverage_quantile(std::uint64_t n, std::uint64_t k, double q);

}  // namespace etlc::check
