// Thresholds from scores, for calibration and for checking thresholds that are read back: the rank
// k, and epsilon beyond or between scores. Alpha is never rounded to binary, which would give a
// wrong k for some alpha and n.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace etlc::check {

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

}  // namespace etlc::check
