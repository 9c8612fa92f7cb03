// Thresholds from scores: which score is taken, and the number beyond it or halfway to the next.
// Takes: alpha as the spec writes it, and scores. Gives: the rank k, exactly, and epsilon. Keeps
// true: no binary rounding of alpha anywhere; with it k would be wrong for some alpha and n. What
// calibrates and what reads thresholds back reckon alike.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace etlc::check {

/// More scores than fit in any memory; ranks are exact up to here.
inline constexpr std::uint64_t kMaxScores = std::uint64_t{1} << 59U;

/// k = ceil((1 - alpha) (n + 1)), Definition "Conformal Calibration Threshold"; n + 1 where n
/// scores are too few. `alpha` is a decimal text in (0, 1).
std::uint64_t rank(std::string_view alpha, std::uint64_t n);

/// The least n with rank(alpha, n) <= n; kMaxScores where no smaller n will do.
std::uint64_t scores_needed(std::string_view alpha);

/// The first float32 strictly above every delta of at most `high`, so far that their difference is
/// a normal number; infinite where there is none.
float strictly_above(double high);

/// Epsilon strictly beyond a score, on the side that takes in more: above it where the comparison
/// is <= or <, else below. Infinite where there is none; 0 rather than -0 below.
float beyond(double score, bool upper_bound);

/// The float32 nearest to the middle of two; nothing where there is none between them.
std::optional<float> halfway(float low, float high);

/// Which of n ascending scores has rank k, counted from the best: the smallest where the comparison
/// is <= or <, else the greatest.
constexpr std::uint64_t at_rank(std::uint64_t k, std::uint64_t n, bool upper_bound) {
    return upper_bound ? k - 1 : n - k;
}

}  // namespace etlc::check
