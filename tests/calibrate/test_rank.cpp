// Tests ranks from the decimal text of alpha, and coverage given a rank.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "check/guarantees/conformal.hpp"
#include "check/guarantees/guarantees.hpp"

namespace etlc::tests {
namespace {

using check::rank;

/// Returns ceil((1 - p / q) (n + 1)) in integers.
std::uint64_t by_integers(std::uint64_t p, std::uint64_t q, std::uint64_t n) {
    return ((q - p) * (n + 1) + q - 1) / q;
}

TEST(Rank, IsExactWhateverTheText) {
    for (std::uint64_t p = 1; p < 1000; ++p) {
        const std::string plain = fmt::format("0.{:03}", p);
        const std::string scientific = fmt::format("{}e-3", p);
        for (std::uint64_t n = 1; n <= 200; ++n) {
            ASSERT_EQ(rank(plain, n), by_integers(p, 1000, n)) << plain << " " << n;
            ASSERT_EQ(rank(scientific, n), by_integers(p, 1000, n)) << scientific << " " << n;
        }
    }
}

TEST(Rank, DoublesWouldBeWrong) {
    std::uint64_t wrong = 0;
    for (std::uint64_t p = 1; p < 1000; ++p)
        for (std::uint64_t n = 1; n <= 200; ++n) {
            const double alpha = static_cast<double>(p) / 1000;
            const auto in_doubles =
                static_cast<std::uint64_t>(std::ceil((1 - alpha) * static_cast<double>(n + 1)));
            wrong += in_doubles != rank(fmt::format("0.{:03}", p), n) ? 1 : 0;
        }
    EXPECT_GT(wrong, 0U);  // otherwise the test above would not exercise exactness
    EXPECT_EQ(rank("0.1", 9), 9U);
    EXPECT_EQ(rank("0.1", 19), 18U);
    EXPECT_EQ(rank("0.1", 8), 9U);  // more than n
    EXPECT_EQ(rank("0.09999999999999999999999999", 9), 10U);
    EXPECT_EQ(rank("0.10000000000000000000000001", 9), 9U);
    EXPECT_EQ(rank("1e-400", 1000000), 1000001U);
}

TEST(Rank, ScoresNeeded) {
    EXPECT_EQ(check::scores_needed("0.1"), 9U);
    EXPECT_EQ(check::scores_needed("0.5"), 1U);
    EXPECT_EQ(check::scores_needed("0.9"), 1U);
    EXPECT_EQ(check::scores_needed("0.05"), 19U);
    EXPECT_EQ(check::scores_needed("0.3"), 3U);
    EXPECT_EQ(check::scores_needed("1e-400"), check::kMaxScores);
    for (std::uint64_t p = 1; p < 1000; ++p) {
        const std::string alpha = fmt::format("0.{:03}", p);
        const std::uint64_t n = check::scores_needed(alpha);
        EXPECT_LE(rank(alpha, n), n);
        if (n == 1) continue;
        EXPECT_GT(rank(alpha, n - 1), n - 1);
    }
}

TEST(Coverage, QuantilesOfTheBetaDistribution) {
    // Beta(n, 1) has P(X <= x) = x^n, Beta(1, n) has 1 - (1 - x)^n.
    for (const std::uint64_t n : {1U, 9U, 50U}) {
        const auto power = 1.0 / static_cast<double>(n);
        EXPECT_NEAR(check::coverage_quantile(n, n, 0.05), std::pow(0.05, power), 1e-12);
        EXPECT_NEAR(check::coverage_quantile(n, 1, 0.95), 1 - std::pow(0.05, power), 1e-12);
    }
    // The 46th of 50 uniform numbers, by simulation; the standard error is about 0.0006 at either
    // end.
    std::mt19937_64 random(7);
    std::vector<double> kth;
    for (int draw = 0; draw < 20000; ++draw) {
        std::vector<double> sample(50);
        for (double& x : sample) x = static_cast<double>(random() >> 11U) * 0x1p-53;
        std::nth_element(sample.begin(), sample.begin() + 45, sample.end());
        kth.push_back(sample[45]);
    }
    std::sort(kth.begin(), kth.end());
    EXPECT_NEAR(check::coverage_quantile(50, 46, 0.05), kth[1000], 0.003);
    EXPECT_NEAR(check::coverage_quantile(50, 46, 0.95), kth[19000], 0.003);
}

}  // namespace
}  // namespace etlc::tests
