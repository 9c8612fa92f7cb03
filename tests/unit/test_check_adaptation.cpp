// Tests how adaptive thresholds are read from their decimal texts: rounded to the side that the
// guarantee needs, and exactly.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <random>

#include "check/guarantees/calibrated.hpp"
#include "check/guarantees/provenance.hpp"
#include "check/numbers/decimal.hpp"
#include "checking.hpp"

namespace etlc::check {

namespace {

Checked adaptive(const std::string& comparison, const std::string& arguments) {
    return Checked(
        fmt::format(
            "spec t; input x : f32; predicate p = x {} calibrated(adaptive, {}); monitor m = F p;",
            comparison, arguments),
        {.allow_uncalibrated = true});
}

bool is_multiple(double x, double grid) {
    return x / grid == std::floor(x / grid) && std::abs(x / grid) <= 0x1p24;
}

TEST(Adaptation, IsAsWritten) {
    const Checked checked = adaptive("<=", "alpha = 0.10, gamma = 0.01, lo = 0.1, hi = 0.6");
    ASSERT_TRUE(checked.model) << checked.diagnostics();
    const Threshold& threshold = checked.predicate("p").threshold;
    EXPECT_EQ(threshold.origin, ThresholdOrigin::adaptive);
    EXPECT_EQ(threshold.text,
              "calibrated(adaptive, alpha = 0.10, gamma = 0.01, lo = 0.1, hi = 0.6)");
    EXPECT_EQ(threshold.alpha, "0.10");
    EXPECT_TRUE(std::isnan(threshold.value));
    EXPECT_EQ(threshold.range().high, 0.6F);  // the float32 above 0.6
    EXPECT_LE(threshold.range().low, 0.1F);
    EXPECT_GE(threshold.range().low, 0.1F - 0x1p-24F);
    EXPECT_EQ(threshold.adaptation->grid, 0x1p-24F);
}

TEST(Adaptation, ArgumentsStandInAnyOrder) {
    const Checked one = adaptive(">", "alpha = 0.1, gamma = 0.5, lo = -2, hi = 3");
    const Checked other = adaptive(">", "hi = 3, lo = -2, gamma = 0.5, alpha = 0.1");
    ASSERT_TRUE(one.model && other.model);
    EXPECT_EQ(one.predicate("p").threshold.text, other.predicate("p").threshold.text);
}

TEST(Adaptation, BinaryFractionsAreExact) {
    const Checked checked = adaptive("<", "alpha = 0.25, gamma = 0.5, lo = -0.75, hi = 1.5");
    ASSERT_TRUE(checked.model) << checked.diagnostics();
    const Adaptation& adaptation = *checked.predicate("p").threshold.adaptation;
    EXPECT_EQ(adaptation.widen, 0.375F);
    EXPECT_EQ(adaptation.tighten, 0.125F);
    EXPECT_EQ(adaptation.range.low, -0.75F);
    EXPECT_EQ(adaptation.range.high, 1.5F);
}

/// A miss moves by at least gamma (1 - alpha), a hit by at most gamma alpha, each by less than
/// about one grid step more or less; [lo, hi] is inside the range. Long doubles are exact enough
/// for the short texts.
TEST(Adaptation, RoundsAgainstTheMissRate) {
    std::mt19937_64 engine(5);
    const auto between = [&](int low, int high) {
        return low + static_cast<int>(engine() % static_cast<unsigned>(high - low + 1));
    };
    for (int n = 0; n < 500; ++n) {
        const int scale = between(-6, 6);  // lo, hi and gamma times 10^scale
        const int alpha = between(1, 99);
        const int lo = between(-9999, 9998);
        const int hi = between(lo + 100, 10099);
        const int gamma = between(20, 100);
        const Checked checked =
            adaptive("<=", fmt::format("alpha = 0.{:02}, gamma = {}e{}, lo = {}e{}, hi = {}e{}",
                                       alpha, gamma, scale, lo, scale, hi, scale));
        ASSERT_TRUE(checked.model) << checked.diagnostics();
        const Adaptation& adaptation = *checked.predicate("p").threshold.adaptation;
        const long double unit = std::pow(10.0L, static_cast<long double>(scale));
        const long double grid = adaptation.grid;
        const long double up = gamma * unit * (100 - alpha) / 100;
        const long double down = gamma * unit * alpha / 100;
        ASSERT_GE(adaptation.widen, up * (1 - 1e-17L)) << checked.file.text();
        ASSERT_LE(adaptation.widen, up * (1 + 1e-12L) + grid) << checked.file.text();
        ASSERT_LE(adaptation.tighten, down * (1 + 1e-17L)) << checked.file.text();
        ASSERT_GE(adaptation.tighten, down * (1 - 1e-12L) - grid) << checked.file.text();
        ASSERT_LE(adaptation.range.low, lo * unit * (lo < 0 ? 1 - 1e-17L : 1 + 1e-17L));
        ASSERT_GE(adaptation.range.low, lo * unit - 2 * grid);
        ASSERT_GE(adaptation.range.high, hi * unit * (hi < 0 ? 1 + 1e-17L : 1 - 1e-17L));
        ASSERT_LE(adaptation.range.high, hi * unit + 2 * grid);
        for (const float x :
             {adaptation.widen, adaptation.tighten, adaptation.range.low, adaptation.range.high})
            ASSERT_TRUE(is_multiple(x, adaptation.grid)) << checked.file.text();
    }
}

TEST(Adaptation, StartsOnTheGenerousSide) {
    const Checked checked = adaptive("<=", "alpha = 0.1, gamma = 0.01, lo = 0.1, hi = 0.6");
    ASSERT_TRUE(checked.model) << checked.diagnostics();
    const Adaptation& adaptation = *checked.predicate("p").threshold.adaptation;
    const float fine = 0.125F + 0x1p-26F;  // between two multiples of 2^-24
    EXPECT_EQ(start(adaptation, fine, true), 0.125F + 0x1p-24F);
    EXPECT_EQ(start(adaptation, fine, false), 0.125F);
    EXPECT_EQ(start(adaptation, 0.5F, true), 0.5F);
    for (const float end : {adaptation.range.low, adaptation.range.high})
        for (const bool upper : {false, true}) EXPECT_EQ(start(adaptation, end, upper), end);
    EXPECT_FALSE(start(adaptation, std::nextafter(adaptation.range.high, 1.0F), true));
    EXPECT_FALSE(start(adaptation, std::nextafter(adaptation.range.low, 0.0F), false));
    EXPECT_FALSE(start(adaptation, std::numeric_limits<float>::infinity(), true));
}

/// The thresholds of tests/spec/ok/adaptive.etl, as if x had this spec's declaration during
/// calibration.
std::string thresholds_for(const std::string& spec) {
    const Checked uncalibrated(spec, {.allow_uncalibrated = true});
    std::ifstream file(std::string(ETLC_SOURCE_DIR) + "/tests/spec/ok/adaptive.thresholds.json");
    std::string json{std::istreambuf_iterator<char>(file), {}};
    const std::string declared = "\"scalar[1] in [0, 4]\"";
    const std::string now = '"' + reads(*uncalibrated.model, 0).at("input x") + '"';
    for (std::size_t at = json.find(declared); at != std::string::npos;
         at = json.find(declared, at + now.size()))
        json.replace(at, declared.size(), now);
    std::string path = testing::TempDir() + "/adaptation.thresholds.json";
    std::ofstream(path) << json;
    return path;
}

/// The range of a predicate covers every threshold that it may have.
TEST(Adaptation, WidensTheRangeOfItsPredicate) {
    const std::string path =
        std::string(ETLC_SOURCE_DIR) + "/tests/spec/ok/adaptive.thresholds.json";
    const Checked checked(
        "spec adaptive; input x : f32 in [0, 4]; input y : f32; predicate low = x <= "
        "calibrated(adaptive, alpha = 0.25, gamma = 0.25, lo = 0.5, hi = 2); predicate high = x > "
        "calibrated(adaptive, alpha = 0.25, gamma = 0.25, lo = 1, hi = 3); truth low = y < 1; "
        "truth high = y > 2; monitor m = F low && G high;",
        {.thresholds_path = path});
    ASSERT_TRUE(checked.model) << checked.diagnostics();
    EXPECT_EQ(checked.predicate("low").threshold.value, 1.0F);
    EXPECT_EQ(checked.predicate("low").robustness.low, -3.5F);
    EXPECT_EQ(checked.predicate("low").robustness.high, 2.0F);
    EXPECT_EQ(checked.predicate("high").threshold.value, 1.5F);
    EXPECT_EQ(checked.predicate("high").robustness.low, -3.0F);
    EXPECT_EQ(checked.predicate("high").robustness.high, 3.0F);
}

/// A warning covers comparisons that every threshold makes true, not those that only the start
/// does.
TEST(Adaptation, ConstantForEveryThreshold) {
    const auto codes = [&](const std::string& range, const std::string& lo) {
        const std::string spec = "spec adaptive; input x : f32 in " + range +
                                 "; input y : f32; predicate low = x <= calibrated(adaptive, alpha "
                                 "= 0.25, gamma = 0.25, lo = " +
                                 lo + ", hi = 2); truth low = y < 1; monitor m = F low;";
        return Checked(spec, {.thresholds_path = thresholds_for(spec)}).codes();
    };
    EXPECT_EQ(codes("[0, 0.75]", "0.5"), "");
    EXPECT_EQ(codes("[0, 0.75]", "0.75"), "W0301");
    EXPECT_EQ(codes("[2, 3]", "0.5"), "");
    EXPECT_EQ(codes("[2.5, 3]", "0.5"), "W0301");
}

}  // namespace

}  // namespace etlc::check
