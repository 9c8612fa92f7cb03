// Tests decimal numbers: exact values, one rounding, outward rounding, durations in steps.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <random>

#include "check/model/model.hpp"
#include "check/numbers/decimal.hpp"
#include "checking.hpp"

namespace etlc::check {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

float rounded(std::string_view text) {
    float value = -1;
    EXPECT_EQ(to_float(text, value), Fit::fits) << text;
    return value;
}

TEST(Decimal, CanonicalText) {
    const auto text = [](std::string_view written) { return Decimal::parse(written).text(); };
    EXPECT_EQ(text("0.50"), "0.5");
    EXPECT_EQ(text("00.5e0"), "0.5");
    EXPECT_EQ(text("5e-1"), "0.5");
    EXPECT_EQ(text("-20.0"), "-20");
    EXPECT_EQ(text("2E+1"), "20");
    EXPECT_EQ(text("0"), "0");
    EXPECT_EQ(text("-0.000"), "0");
    EXPECT_EQ(text("0e99999999999999999999"), "0");
    EXPECT_EQ(text("1e3"), "1000");
    EXPECT_EQ(text("1234.5678"), "1234.5678");
    EXPECT_EQ(text("1e22"), "1e22");
    EXPECT_EQ(text("12.5e-9"), "1.25e-8");
}

TEST(Decimal, Order) {
    const auto less = [](std::string_view a, std::string_view b) {
        return Decimal::parse(a) < Decimal::parse(b);
    };
    EXPECT_TRUE(less("-1", "0"));
    EXPECT_TRUE(less("-10", "-9"));
    EXPECT_TRUE(less("0.9", "0.91"));
    EXPECT_TRUE(less("9", "10"));
    EXPECT_TRUE(less("1e-400", "1e-399"));
    EXPECT_TRUE(less("0.99999999999999999999999999", "1"));
    EXPECT_FALSE(less("0.10", "0.1"));
    EXPECT_EQ(Decimal::parse("0.10"), Decimal::parse("1e-1"));
}

TEST(Decimal, WholeNumbers) {
    EXPECT_EQ(Decimal::parse("1e3").whole(1000), 1000U);
    EXPECT_EQ(Decimal::parse("1e3").whole(999), std::nullopt);
    EXPECT_EQ(Decimal::parse("2.50").whole(10), std::nullopt);
    EXPECT_EQ(Decimal::parse("2.0").whole(10), 2U);
    EXPECT_EQ(Decimal::parse("-2").whole(10), std::nullopt);
    EXPECT_EQ(Decimal::parse("-0").whole(10), 0U);
    EXPECT_EQ(Decimal::parse("18446744073709551615").whole(UINT64_MAX), UINT64_MAX);
    EXPECT_EQ(Decimal::parse("18446744073709551616").whole(UINT64_MAX), std::nullopt);
    EXPECT_EQ(Decimal::parse("1e400").whole(UINT64_MAX), std::nullopt);
}

TEST(Decimal, OfADoubleIsExact) {
    EXPECT_EQ(Decimal::of(0.5).text(), "0.5");
    EXPECT_EQ(Decimal::of(static_cast<double>(0.1F)).text(), "0.100000001490116119384765625");
    EXPECT_EQ(Decimal::of(std::numeric_limits<double>::denorm_min()).digits.size(), 751U);
}

TEST(Float, IsRoundedOnce) {
    // Halfway between 1 and its successor, and slightly above: through a double both would become
    // the half.
    EXPECT_EQ(rounded("1.000000059604644775390625"), 1.0F);
    EXPECT_EQ(rounded("1.00000005960464477539062500000000000000001"), std::nextafter(1.0F, 2.0F));
    EXPECT_EQ(rounded("16777217"), 16777216.0F);
    EXPECT_EQ(rounded("1e-45"), std::numeric_limits<float>::denorm_min());
    EXPECT_EQ(rounded("3.4028235677973366163753939545814e38"), std::numeric_limits<float>::max());
}

TEST(Float, OverflowAndUnderflow) {
    float value = 0;
    EXPECT_EQ(to_float("3.4028235677973366163753939545815e38", value),
              Fit::overflow);  // halfway to 2^128
    EXPECT_EQ(value, kInfinity);
    EXPECT_EQ(to_float("-1e39", value), Fit::overflow);
    EXPECT_EQ(value, -kInfinity);
    EXPECT_EQ(to_float("7e-46", value), Fit::underflow);
    EXPECT_EQ(value, 0.0F);
    EXPECT_EQ(to_float("1e-99999999999999999999", value), Fit::underflow);
    EXPECT_EQ(to_float("0.000", value), Fit::fits);
    EXPECT_EQ(to_float("-0", value), Fit::fits);
    EXPECT_FALSE(std::signbit(value));
}

TEST(Float, OutwardRoundingEncloses) {
    std::mt19937 random(7);
    for (int i = 0; i < 20000; ++i) {
        const auto value = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
        if (!std::isfinite(value)) continue;
        Decimal exact = Decimal::of(static_cast<double>(value));
        EXPECT_EQ(round_down(exact.text()), value);
        EXPECT_EQ(round_up(exact.text()), value);
        if (exact.is_zero()) continue;
        exact.digits +=
            "000000000000000000000000000001";  // away from zero by much less than half an ulp
        const std::string text = exact.text();
        const float away = std::nextafter(value, exact.negative ? -kInfinity : kInfinity);
        EXPECT_EQ(round_down(text), exact.negative ? away : value) << text;
        EXPECT_EQ(round_up(text), exact.negative ? value : away) << text;
    }
}

TEST(Float, OutwardRoundingAtTheEnds) {
    EXPECT_EQ(round_down("inf"), kInfinity);
    EXPECT_EQ(round_up("-inf"), -kInfinity);
    EXPECT_EQ(round_up("1e39"), kInfinity);
    EXPECT_EQ(round_down("1e39"), std::numeric_limits<float>::max());
    EXPECT_EQ(round_down("-1e39"), -kInfinity);
    EXPECT_EQ(round_down("1e-99"), 0.0F);
    EXPECT_EQ(round_up("1e-99"), std::numeric_limits<float>::denorm_min());
    EXPECT_EQ(round_down("-1e-99"), -std::numeric_limits<float>::denorm_min());
}

TEST(Float, RangesOfInputsAreRoundedOutward) {
    const Checked checked("spec t; input x : f32 in [0.1, 0.3]; monitor m = G x > 0.1;");
    ASSERT_TRUE(checked.model) << checked.diagnostics();
    const Range& range = checked.model->inputs[0].range;
    EXPECT_EQ(range.low, std::nextafter(0.1F, 0.0F));  // 0.1F is above 0.1
    EXPECT_EQ(range.high, 0.3F);                       // 0.3F is above 0.3
    EXPECT_EQ(checked.model->predicates[0].threshold.value, 0.1F);
    EXPECT_EQ(checked.model->predicates[0].threshold.value64, 0.1);
}

// ---- time ---------------------------------------------------------------------------------------

StepCount steps(std::string_view duration, std::string_view unit, std::string_view step,
                std::string_view step_unit) {
    return count_steps({Decimal::parse(duration), unit}, {Decimal::parse(step), step_unit});
}

TEST(Duration, CountsExactly) {
    const auto whole = [](const StepCount& count) {
        return count.whole && !count.too_many ? static_cast<std::int64_t>(count.floor) : -1;
    };
    EXPECT_EQ(whole(steps("0.29", "s", "100", "Hz")), 29);  // in doubles 28.999999999999996
    EXPECT_EQ(whole(steps("2", "s", "20", "Hz")), 40);
    EXPECT_EQ(whole(steps("1.5", "min", "0.1", "Hz")), 9);
    EXPECT_EQ(whole(steps("100", "ms", "50", "ms")), 2);
    EXPECT_EQ(whole(steps("3", "min", "1.5", "min")), 2);
    EXPECT_EQ(whole(steps("1", "s", "0.1", "ms")), 10000);
    EXPECT_EQ(whole(steps("1", "us", "1e6", "Hz")), 1);
    EXPECT_EQ(whole(steps("0", "s", "33.3", "Hz")), 0);
    EXPECT_EQ(whole(steps("100", "ms", "30", "Hz")), 3);
    EXPECT_EQ(whole(steps("2147483646", "s", "1", "Hz")), 2147483646);
    EXPECT_EQ(whole(steps("999999999999999999e-9", "s", "1e-9", "Hz")), -1);
    EXPECT_EQ(whole(steps("123456789e9", "us", "1e-6", "Hz")), -1);
    EXPECT_EQ(whole(steps("123456789e9", "us", "1e-2", "Hz")), 1234567890);
}

TEST(Duration, TellsWhatIsNotWhole) {
    const StepCount third = steps("30", "ms", "30", "Hz");
    EXPECT_FALSE(third.whole);
    EXPECT_FALSE(third.too_many);
    EXPECT_EQ(third.floor, 0U);
    EXPECT_EQ(steps("0.125", "s", "20", "Hz").floor, 2U);
    EXPECT_FALSE(steps("0.125", "s", "20", "Hz").whole);
    EXPECT_FALSE(steps("1e-200", "s", "20", "Hz").whole);
    EXPECT_TRUE(steps("1e200", "s", "20", "Hz").too_many);
    EXPECT_TRUE(steps("2147483647", "s", "1", "Hz").too_many);
    EXPECT_TRUE(steps("2147483646.5", "s", "1", "Hz").too_many);
    EXPECT_FALSE(steps("0.999999999999999999", "s", "1", "Hz").whole);
    EXPECT_FALSE(steps("123456789012345678e-18", "s", "987654321098765432e-18", "s").whole);
}

/// Compared with fractions of small integers: n / 1000 s at r / 100 Hz.
TEST(Duration, AgreesWithSmallFractions) {
    for (std::uint64_t n = 1; n < 400; n += 7) {
        for (std::uint64_t r = 1; r < 20000; r += 131) {
            const std::string time = std::to_string(n) + "e-3", rate = std::to_string(r) + "e-2";
            const StepCount count = steps(time, "s", rate, "Hz");
            EXPECT_EQ(count.floor, n * r / 100000) << time << " at " << rate;
            EXPECT_EQ(count.whole, n * r % 100000 == 0) << time << " at " << rate;
            const StepCount by_period = steps(time, "s", rate, "ms");
            EXPECT_EQ(by_period.floor, n * 100 / r);
            EXPECT_EQ(by_period.whole, n * 100 % r == 0);
        }
    }
}

TEST(Duration, TextOfSteps) {
    const auto text = [](std::uint64_t n, std::string_view step, std::string_view step_unit,
                         std::string_view unit) {
        return duration_text(n, {Decimal::parse(step), step_unit}, unit);
    };
    EXPECT_EQ(text(3, "20", "Hz", "ms"), "150 ms");
    EXPECT_EQ(text(3, "20", "Hz", "s"), "0.15 s");
    EXPECT_EQ(text(1, "30", "Hz", "ms"), "100/3 ms");
    EXPECT_EQ(text(3, "30", "Hz", "s"), "0.1 s");
    EXPECT_EQ(text(90, "1", "s", "min"), "1.5 min");
    EXPECT_EQ(text(0, "30", "Hz", "s"), "0 s");
    EXPECT_EQ(text(2147483646, "12.5", "us", "us"), "26843545575 us");
}

TEST(Duration, IntervalsOfASpec) {
    const Checked checked(
        "spec t; rate 100 Hz; input x : f32; predicate p = x > 0;"
        "sliding monitor a = G[0, 0.29 s] p; sliding monitor b = F[10 ms, 0.1 min] p; sliding "
        "monitor c = G[0 s, 3 s] p;"
        "monitor d = F[20 ms, inf] p;");
    ASSERT_TRUE(checked.model) << checked.diagnostics();
    EXPECT_EQ(checked.formula("a"), "G[0, 29] p");
    EXPECT_EQ(checked.formula("b"), "F[1, 600] p");
    EXPECT_EQ(checked.formula("c"), "G[0, 300] p");
    EXPECT_EQ(checked.formula("d"), "F[2, inf] p");
    EXPECT_EQ(checked.model->step_seconds, 0.01);
}

// ---- intended steps

std::string with_rate(const std::string& rest) {
    return Checked("spec t; rate 30 Hz; input p, q : bool; " + rest).codes();
}

TEST(BareBounds, AreWarnedOfOnceWhereNothingSaysSteps) {
    for (const char* formula :
         {"F[0, 2] p", "G[1, 2] p", "p U[0, 2] q", "p R[2, inf] q", "G O[0, 1] p", "G H[0, 2] p",
          "G (p S[0, 2] q)", "G held[3] p", "F[0, 2 s] p && F[0, 2] q"})
        EXPECT_EQ(with_rate(std::string("monitor m = ") + formula + " || F (p && q);"), "W0506")
            << formula;
    EXPECT_EQ(with_rate("monitor m = G[0, 2] p; monitor n = F[3, 9] q;"), "W0506");
    EXPECT_EQ(with_rate("const n = 2; monitor m = F[0, n] (p && q);"), "W0506");
    EXPECT_EQ(with_rate("input x : f32; predicate a = x > 1; "
                        "truth a = H[0, 2] p; monitor m = G (q -> a);"),
              "W0506");
}

TEST(BareBounds, AreRightOnPurposeAndWithoutARate) {
    for (const char* rest :
         {"monitor m = F[0, 2 steps] p || G[0, 5] q;", "monitor m = G held[1 step] (p && q);",
          "const n = 2 steps; monitor m = F[0, n] (p && q);",
          "const n = 2; monitor m = F[0, n steps] (p && q);",
          "const n = 2; monitor m = F[0, n s] (p && q);",
          "input x : f32 hold 3; monitor m = F[0, 2 s] (p && q && x > 1);",
          "monitor m = F[0, inf] (p && q);", "monitor m = G (p -> F[0, 1 min] q);"})
        EXPECT_EQ(with_rate(rest), "") << rest;
    EXPECT_EQ(Checked("spec t; input p : bool; monitor m = F[0, 2] p;").codes(), "");
}

TEST(Steps, AreAUnitOfBoundsHoldsAndConstants) {
    const Checked checked(
        "spec t; rate 10 Hz; const n = 3 steps; const d = 0.3 s; input p : bool hold 2 steps; "
        "input q : bool hold 500 ms; input r : bool hold n; input o : bool hold d; "
        "monitor m = F[1 step, n] (p && q && r && o);",
        {.settings = {{"n", "4", "steps"}}});
    ASSERT_EQ(checked.codes(), "") << checked.diagnostics();
    EXPECT_EQ(checked.formula("m"), "F[1, 4] (p && q && r && o)");
    std::vector<std::uint32_t> holds;
    for (const Input& input : checked.model->inputs) holds.push_back(input.hold);
    EXPECT_EQ(holds, (std::vector<std::uint32_t>{2, 5, 4, 3}));
}

TEST(Steps, AreThoseAfterWhichASampleIsStale) {
    const Checked checked(
        "spec t; rate 10 Hz, durations up; const n = 3 steps; const d = 0.35 s; const k = 7; "
        "input p : f32, stale after 2; input q : f32 in [0, 1] hold 1, stale after 1 step; "
        "input r : f16[2] hold n, stale after n; input o : i8[2] scale 1, stale after d; "
        "input u : f32[2], stale after k; input v : f32;"
        "target t = [[0, 0]]; monitor m = G (p > q && v > 0 && l2(r, t) > 1 && l2(o, t) > 1 && "
        "l2(u, t) > 1);");
    ASSERT_EQ(checked.codes(), "") << checked.diagnostics();
    std::vector<std::uint32_t> most;
    for (const Input& input : checked.model->inputs) most.push_back(input.stale_after);
    EXPECT_EQ(most, (std::vector<std::uint32_t>{2, 1, 3, 4, 7, 0}));
    EXPECT_EQ(checked.model->rounded.count("d = 0.35 s"), 1U);
}

TEST(Steps, AfterWhichASampleIsStaleAreAtLeastOne) {
    const auto codes = [](const std::string& after) {
        return with_rate("input x : f32, stale after " + after +
                         "; monitor m = G (p && q && x > 1);");
    };
    for (const char* good : {"1", "1 step", "2147483646", "100 ms", "n", "0.1 s"})
        EXPECT_EQ(codes(std::string(good) == "n" ? "n; const n = 2 steps" : good), "") << good;
    for (const char* bad : {"0", "0 steps", "1.5", "2147483647", "0 s", "0 ms", "n; const n = -1"})
        EXPECT_EQ(codes(bad), "E0319") << bad;
    EXPECT_EQ(codes("20 ms"), "E0505");
    EXPECT_EQ(codes("1e9 s"), "E0507");
    EXPECT_EQ(Checked("spec t; input x : f32, stale after 1 s; monitor m = F x > 1;").codes(),
              "E0503");
    EXPECT_EQ(Checked("spec t; rate 10 Hz, durations down; input x : f32, stale after 20 ms; "
                      "monitor m = F x > 1;")
                  .codes(),
              "E0515");
    EXPECT_EQ(with_rate("input b : bool, stale after 2; monitor m = G (p && q && b);"), "E0319");
}

TEST(Steps, AreNoTime) {
    EXPECT_EQ(with_rate("monitor m = F[1 step, 2 s] (p && q);"), "E0504");
    EXPECT_EQ(with_rate("monitor m = F[0, 1.5 steps] (p && q);"), "E0506");
    EXPECT_EQ(with_rate("const n = 2 steps; predicate a = n > 1; monitor m = G (a && p && q);"),
              "E0209");
    EXPECT_EQ(with_rate("input x : f32 hold 20 ms; monitor m = G (p && q && x > 1);"), "E0505");
    EXPECT_EQ(
        Checked("spec t; const n = 2 steps; period n; input p : bool; monitor m = F p;").codes(),
        "E0209");
    EXPECT_EQ(Checked("spec t; input x : f32 hold 1 s; monitor m = F x > 1;").codes(), "E0503");
}

}  // namespace
}  // namespace etlc::check
