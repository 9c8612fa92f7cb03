// Conformal ranks, and what a rank among n says about coverage.
// Takes: alpha as the spec writes it, and the number of scores. Gives: k, exactly. Keeps true: no binary rounding of
// alpha anywhere; with it k would be wrong for some alpha and n.
#pragma once

#include <cstdint>
#include <string_view>

namespace etlc::calibrate {

/// More scores than fit in any memory; ranks are exact up to here.
inline constexpr std::uint64_t kMaxScores = std::uint64_t{1} << 59U;

/// k = ceil((1 - alpha) (n + 1)), Definition "Conformal Calibration Threshold"; n + 1 where n scores are too few.
/// `alpha` is a decimal text in (0, 1).
std::uint64_t rank(std::string_view alpha, std::uint64_t n);

/// The least n with rank(alpha, n) <= n; kMaxScores where no smaller n will do.
std::uint64_t scores_needed(std::string_view alpha);

}  // namespace etlc::calibrate
