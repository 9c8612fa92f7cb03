// Thresholds from scores: the rank k, and epsilon beyond or between scores. Alpha is never rounded
// to binary, which would give a wrong k for some alpha and n. Whoever reads a thresholds file
// computes both again, so a number that was changed alone is detected.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "artifacts/thresholds.hpp"
#include "check/model/model.hpp"

namespace etlc::check {

/// Whether the method takes one score of each group of episodes, and keeps them all. The others
/// keep the chosen score, f1 also the next.
constexpr bool takes_scores(std::string_view method) {
    return method == "conformal" || method == "adaptive" || method == "normal";
}

/// Whether the method counts groups of episodes; the others pool frames.
constexpr bool takes_groups(std::string_view method) {
    return takes_scores(method) || method == "risk";
}

/// Whether the threshold is above the scores that it accepts, where it bounds misses, or below
/// those that it leaves out, where it bounds false positives; mirrored for >= and >. A shift bounds
/// rho from below: `upper_bound` is false. Against both it is about the threshold against misses;
/// the inner one is on the other side.
constexpr bool is_above(Against against, bool upper_bound) {
    const bool of_positives = against == Against::misses || against == Against::missed_success ||
                              against == Against::both;
    return upper_bound == of_positives;
}

/// Limit up to which ranks are exact; more scores fit in no memory.
inline constexpr std::uint64_t kMaxScores = std::uint64_t{1} << 59U;

/// Returns k = ceil((1 - alpha) (n + 1)), Definition "Conformal Calibration Threshold"; n + 1 if n
/// scores are too few. `alpha` is a decimal text in (0, 1).
std::uint64_t rank(std::string_view alpha, std::uint64_t n);

/// Returns the least n with rank(alpha, n) <= n; kMaxScores if there is no smaller one.
std::uint64_t scores_needed(std::string_view alpha);

/// Returns the first float32 that exceeds `high`, and every smaller delta, by at least a normal
/// number; otherwise infinity.
float strictly_above(double high);

/// Returns epsilon just beyond a score on the side of more detections: above it for <= and <,
/// otherwise below. May be infinite; never -0.
float beyond(double score, bool upper_bound);

/// Returns the float32 nearest to the middle of two; nothing if none lies between them.
std::optional<float> halfway(float low, float high);

/// Returns the index of the score with rank k among n ascending ones, counted from the best: from
/// the smallest for <= and <, otherwise from the greatest.
constexpr std::uint64_t at_rank(std::uint64_t k, std::uint64_t n, bool upper_bound) {
    return upper_bound ? k - 1 : n - k;
}

/// Returns the infinite threshold of a side whose scores are too few: nothing is beyond it.
float infinite(bool above);

/// Whether thresholds with these losses, one a group, keep the expected loss of a new one at alpha
/// (Angelopoulos et al., "Conformal Risk Control", 2022): n / (n + 1) mean + 1 / (n + 1) <= alpha,
/// in integers, rounded to the safe side.
bool keeps_risk(const std::vector<double>& losses, std::string_view alpha);

/// The thresholds against both errors, from that against misses and that against false positives.
/// Where they do not overlap the demonstrations are separated: one threshold is halfway.
struct Both {
    float value = 0;
    std::optional<float> inner;

    float low() const { return inner.value_or(value); }
};
Both both(float against_misses, float against_false_positives, bool upper_bound);

/// The first inconsistent number: "'predicates.at_a.k' is 1, expected 37: the rank of alpha = 0.1
/// among 40 scores".
struct Contradiction {
    std::string message;
    bool by_hand = false;  ///< the threshold itself, which somebody may have edited
};

/// `place` is the key of the entry, "predicates.at_a". `upper_bound`: of a predicate with <= or <,
/// and of a duration that makes its monitor truer, not of a monitor's shift. `episodes` were used
/// for calibration; `may_repeat`: those of bools alone, which differ in nothing that is compared.
std::optional<Contradiction> contradiction(const thresholds::Entry& entry, const std::string& place,
                                           bool upper_bound,
                                           const std::vector<std::uint64_t>& episodes,
                                           const thresholds::GroupNames& groups,
                                           bool may_repeat = false);

}  // namespace etlc::check
