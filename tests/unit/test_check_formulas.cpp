// Tests formulas: order of the DAG, canonical text, horizons, constancy.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "check/formulas/horizons.hpp"
#include "checking.hpp"
#include "reference/reference.hpp"

namespace etlc::check {
namespace {

using Kind = Formula::Kind;

constexpr const char* kHead =
    "spec t; input x : f32; input on : bool; predicate p = x > 0; predicate q = x < 1; ";

Checked monitor(const std::string& formula, bool sliding = false) {
    return Checked(fmt::format("{}{}monitor m = {};", kHead, sliding ? "sliding " : "", formula));
}

std::string canonical(const std::string& formula) {
    const Checked checked = monitor(formula);
    return checked.model ? checked.formula("m") : checked.diagnostics();
}

TEST(Canonical, MinimalParentheses) {
    EXPECT_EQ(canonical("(((p)))"), "p");
    EXPECT_EQ(canonical("F (p && F q)"), "F (p && F q)");
    EXPECT_EQ(canonical("(F p) && q"), "F p && q");
    EXPECT_EQ(canonical("!(p && q)"), "!(p && q)");
    EXPECT_EQ(canonical("not (not p)"), "!!p");
    EXPECT_EQ(canonical("(p && q) || on"), "p && q || on");
    EXPECT_EQ(canonical("p && (q || on)"), "p && (q || on)");
    EXPECT_EQ(canonical("(p -> q) -> on"), "(p -> q) -> on");
    EXPECT_EQ(canonical("p -> (q -> on)"), "p -> q -> on");
    EXPECT_EQ(canonical("(p <-> q) <-> on"), "p <-> q <-> on");
    EXPECT_EQ(canonical("p <-> (q <-> on)"), "p <-> (q <-> on)");
    EXPECT_EQ(canonical("(p U q) U on"), "(p U q) U on");
    EXPECT_EQ(canonical("p U (q R on)"), "p U q R on");
    EXPECT_EQ(canonical("(p && q) U on"), "(p && q) U on");
    EXPECT_EQ(canonical("p && (q U on)"), "p && q U on");
    EXPECT_EQ(canonical("G (x > 1)"), "G x > 1");
}

TEST(Canonical, WordsAndIntervals) {
    EXPECT_EQ(canonical("always (p implies eventually[0, 3] q)"), "G (p -> F[0, 3] q)");
    EXPECT_EQ(canonical("p until[2, inf] q"), "p U[2, inf] q");
    EXPECT_EQ(canonical("G[0, inf] p"), "G p");
    EXPECT_EQ(canonical("p weak_until q or next previous p"), "p W q || X Y p");
    EXPECT_EQ(canonical("historically[0, 0] p && F (p since q) && once true release false"),
              "H[0, 0] p && F (p S q) && O true R false");
}

TEST(Canonical, Counts) {
    EXPECT_EQ(canonical("F count((p && q), 9 steps) >= 3"), "F count(p && q, 9 steps) >= 3");
    EXPECT_EQ(canonical("count(p, 9) > 3"), "count(p, 9 steps) >= 4");
    EXPECT_EQ(canonical("count(p, 9) < 3 && p"), "count(p, 9 steps) < 3 && p");
    EXPECT_EQ(canonical("!count(p, 9) <= 3"), "!count(p, 9 steps) < 4");
    EXPECT_EQ(canonical("3 > count(rise p, 9)"), "count(rise p, 9 steps) < 3");
    EXPECT_EQ(canonical("count(p, 9) == 0"), "count(p, 9 steps) < 1");
    EXPECT_EQ(canonical("count(p, 9) == 2"), "count(p, 9 steps) >= 2 && count(p, 9 steps) < 3");
    EXPECT_EQ(canonical("count(p, 9) == 5"), "count(p, 9 steps) >= 5");
    EXPECT_EQ(canonical("2 != count(p, 9)"), "!(count(p, 9 steps) >= 2 && count(p, 9 steps) < 3)");
}

/// The least number of steps is that of the exact share: 0.8 of 50 is 40. The text is a share that
/// asks for as many.
TEST(Canonical, Fractions) {
    EXPECT_EQ(canonical("F fraction((p && q), 50 steps) >= 0.8"),
              "F fraction(p && q, 50 steps) >= 0.8");
    EXPECT_EQ(canonical("fraction(p, 50) > 0.8"), "fraction(p, 50 steps) >= 0.82");
    EXPECT_EQ(canonical("fraction(p, 50) >= 0.81"), "fraction(p, 50 steps) >= 0.82");
    EXPECT_EQ(canonical("fraction(p, 50) > 0.79"), "fraction(p, 50 steps) >= 0.8");
    EXPECT_EQ(canonical("!fraction(p, 9) <= 0.5"), "!fraction(p, 9 steps) < 0.5");
    EXPECT_EQ(canonical("0.5 > fraction(p, 8)"), "fraction(p, 8 steps) < 0.5");
    EXPECT_EQ(canonical("fraction(p, 8) <= 0.5"), "fraction(p, 8 steps) < 0.6");
    EXPECT_EQ(canonical("fraction(p, 7) >= 1"), "fraction(p, 7 steps) >= 1");
    EXPECT_EQ(canonical("1.00 <= fraction(p, 7)"), "fraction(p, 7 steps) >= 1");
    EXPECT_EQ(canonical("fraction(p, 7) > 0"), "fraction(p, 7 steps) >= 0.1");
    EXPECT_EQ(canonical("fraction(p, 7) >= 1e-30"), "fraction(p, 7 steps) >= 0.1");
    EXPECT_EQ(canonical("fraction(p, 16777216) >= 0.99999999999999999999"),
              "fraction(p, 16777216 steps) >= 1");
    EXPECT_EQ(canonical("fraction(p, 16777216) > 0.9999999"),
              "fraction(p, 16777216 steps) >= 0.9999999");
    // Their texts mean the same, whatever the number of steps.
    for (std::uint32_t n = 1; n < 60; ++n)
        for (std::uint32_t k = 1; k <= n; ++k) {
            const std::string text =
                fmt::format("fraction(p, {} steps) >= {}", n, check::share_text(k, n));
            const Checked checked = monitor(text);
            ASSERT_TRUE(checked.model) << text;
            const check::Formula& top = checked.model->formulas[checked.model->monitors[0].formula];
            EXPECT_EQ(top.index, k) << text;
            EXPECT_EQ(canonical(text), text);
        }
}

TEST(Canonical, Expressions) {
    const Checked checked(
        "spec t; input x, y : f32; input z : f32[2]; target t1 = [[1, 2]]; target t2 = [[1, 2], "
        "[2, 1]];"
        "predicate a = x - (y - 0.50) * 2e0 <= 1; predicate b = -(x + y) / -y > 1.50; predicate c "
        "= abs(x) + min(x, y, 3) < 1;"
        "predicate d = min  l2( z ,t1 ) <= 1; predicate e = kth(2) linf(z, t2) - mean cosine([x, "
        "y], t2) <= -1;"
        "predicate f = mahalanobis([[1.0, 0], [0, 1]])(z, t1) < 1; monitor m = G (a && b && c && d "
        "&& e && f);");
    ASSERT_TRUE(checked.model) << checked.diagnostics();
    EXPECT_EQ(checked.predicate("a").text, "x - (y - 0.5) * 2 <= ");
    EXPECT_EQ(checked.predicate("b").text, "-(x + y) / -y > ");
    EXPECT_EQ(checked.predicate("b").threshold.text, "1.50");
    EXPECT_EQ(checked.predicate("c").text, "abs(x) + min(x, y, 3) < ");
    EXPECT_EQ(checked.predicate("d").text,
              "l2(z, t1) <= ");  // one row: every aggregation is the distance
    EXPECT_EQ(checked.predicate("e").text, "kth(2) linf(z, t2) - mean cosine([x, y], t2) <= ");
    EXPECT_EQ(checked.predicate("f").text, "mahalanobis([[1, 0], [0, 1]])(z, t1) < ");
}

TEST(Canonical, NumbersOfEarlierSteps) {
    const Checked checked(
        "spec t; rate 10 Hz; const k = 5; const d = 0.5 s; input x : f32 in [-3, 9]; input z : "
        "f32[2]; target t1 = [[1, 2]];"
        "predicate a = x@1@0.2s - (x - 0.50)@3 <= 1; predicate b = x@3 steps > 1.5;"
        "predicate c = mean(l2(z, t1), k steps) < 1; predicate d2 = mean(l2(z,t1), d)@1s < 1;"
        "predicate e = min(x, k) - min(x, d) < 1; predicate f = max(mean(x, 1 step), 2 steps) < 1;"
        "monitor m = G (a && b && c && d2 && e && f);");
    ASSERT_TRUE(checked.model) << checked.diagnostics();
    EXPECT_EQ(checked.predicate("a").text, "x@3 - (x - 0.5)@3 <= ");
    EXPECT_EQ(checked.predicate("b").text, "x@3 > ");
    EXPECT_EQ(checked.predicate("c").text, "mean(l2(z, t1), 5 steps) < ");
    EXPECT_EQ(checked.predicate("d2").text, "mean(l2(z, t1), 5 steps)@10 < ");
    EXPECT_EQ(checked.predicate("e").text, "min(x, 5) - min(x, 5 steps) < ");
    EXPECT_EQ(checked.predicate("f").text, "max(x, 2 steps) < ");
    std::vector<std::string> pasts;
    for (const check::Past& past : checked.model->pasts) pasts.push_back(past.text);
    EXPECT_EQ(pasts, (std::vector<std::string>{"x@3", "(x - 0.5)@3", "mean(l2(z, t1), 5 steps)",
                                               "mean(l2(z, t1), 5 steps)@10", "min(x, 5 steps)",
                                               "max(x, 2 steps)"}));
    EXPECT_EQ(checked.model->pasts[0].range.low, -3);
    EXPECT_EQ(checked.model->pasts[1].range.high, 8.5F);
    EXPECT_EQ(checked.model->pasts[2].range.low, 0);
}

class RandomFormulas {
public:
    explicit RandomFormulas(unsigned seed) : random_(seed) {}

    std::string formula(int depth) {
        static const std::vector<std::string> atoms{"p", "q", "on", "x > 0.5", "true", "false"};
        static const std::vector<std::string> prefixes{
            "!",  "X ", "F ",       "G ",         "F[1, 3] ", "G[0, 2] ", "F[1, inf] ", "Y ",
            "O ", "H ", "O[1, 2] ", "H[1, inf] ", "rise ",    "fall ",    "held[2] "};
        static const std::vector<std::string> infixes{" && ",      " || ", " -> ",     " <-> ",
                                                      " U ",       " W ",  " R ",      " U[1, 2] ",
                                                      " R[0, 3] ", " S ",  " S[1, 2] "};
        if (depth == 0) return atoms[random_() % atoms.size()];
        if (random_() % 2 == 0)
            return fmt::format("{}({})", prefixes[random_() % prefixes.size()], formula(depth - 1));
        const std::string left = formula(depth - 1);
        return fmt::format("({}){}({})", left, infixes[random_() % infixes.size()],
                           formula(depth - 1));
    }

private:
    std::mt19937 random_;
};

/// Returns every formula in full brackets.
std::string structure(const Model& model, Index index) {
    const Formula& f = model.formulas[index];
    std::string text = fmt::format("({}[{},{}]", static_cast<int>(f.kind), f.low, f.high);
    if (f.kind == Kind::predicate)
        text += model.predicates[f.index].text + model.predicates[f.index].name;
    if (f.kind == Kind::boolean_input) text += model.inputs[f.index].name;
    for (const Index operand : f.operands) text += structure(model, operand);
    return text.append(")");
}

TEST(Canonical, ReadsBackAsTheSameFormula) {
    RandomFormulas random(3);
    int compared = 0;
    for (int i = 0; i < 500; ++i) {
        const Checked first = monitor(random.formula(4));
        if (!first.model) continue;  // a past operator over a future one
        const std::string text = first.formula("m");
        const Checked second = monitor(text);
        ASSERT_TRUE(second.model) << second.diagnostics();
        EXPECT_EQ(second.formula("m"), text);
        // && and || within && and || lose redundant brackets; everything else is the same tree.
        const bool flat =
            text.find("&&") == std::string::npos && text.find("||") == std::string::npos;
        if (flat) {
            EXPECT_EQ(structure(*first.model, first.monitor("m").formula),
                      structure(*second.model, second.monitor("m").formula))
                << text;
        }
        ++compared;
    }
    EXPECT_GT(compared, 100);
}

TEST(Canonical, ManyLetsStayShort) {
    std::string text = fmt::format("{}let l0 = p && q;", kHead);
    for (int i = 1; i < 100; ++i) {
        text += fmt::format("let l{0} = X l{1} && l{1};", i, i - 1);
    }
    const Checked checked(text + "monitor m = G l99;");
    ASSERT_TRUE(checked.model) << checked.diagnostics();
    EXPECT_EQ(checked.formula("m"), "G l99");
    EXPECT_LT(checked.model->formulas.size(), 500U);
}

// ---- the DAG ------------------------------------------------------------------------------------

TEST(Dag, OperandsComeFirstAndLetsAreShared) {
    const Checked checked(std::string(kHead) +
                          "monitor a = G (later && F l); let l = F (k || on); let k = p U q; let "
                          "later = l; monitor b = l;");
    ASSERT_TRUE(checked.model) << checked.diagnostics();
    const Model& model = *checked.model;
    for (Index i = 0; i < model.formulas.size(); ++i)
        for (const Index operand : model.formulas[i].operands) EXPECT_LT(operand, i);
    EXPECT_EQ(model.lets[0].name, "l");
    EXPECT_EQ(model.lets[0].formula, model.lets[2].formula);
    EXPECT_EQ(checked.monitor("b").formula, model.lets[0].formula);
    EXPECT_EQ(checked.formula("a"), "G (F (p U q || on) && F F (p U q || on))");
}

TEST(Dag, ComparisonsInFormulasAreSharedAndComeAfterNamedPredicates) {
    const Checked checked(
        "spec t; input x, y : f32; monitor a = G (x > 0.5 || y * 2 <= 1); predicate p = x > 0.5;"
        "truth p = x > 0.50; monitor b = F (p && x > 5e-1);");
    ASSERT_TRUE(checked.model) << checked.diagnostics();
    const Model& model = *checked.model;
    ASSERT_EQ(model.predicates.size(), 3U);
    EXPECT_EQ(model.predicates[0].name, "p");
    EXPECT_EQ(model.predicates[1].name, "");
    EXPECT_EQ(model.predicates[1].text, "x > ");
    EXPECT_EQ(model.predicates[2].text, "y * 2 <= ");
    EXPECT_EQ(model.predicates[2].inputs, std::vector<Index>{1});
}

TEST(Dag, EqualDistancesStandOnce) {
    const Checked checked(
        "spec t; input z : f32[2]; target a = [[1, 2]]; target b = [[2, 1], [3, 3]];"
        "predicate p = l2(z, a) <= 1; predicate q = min l2(z, a) - min l2(z, b) < 0; predicate r = "
        "max l2(z, b) < 9;"
        "monitor m = F (p && q && r);");
    ASSERT_TRUE(checked.model) << checked.diagnostics();
    EXPECT_EQ(checked.model->distances.size(), 3U);
    EXPECT_TRUE(checked.predicate("p").plain_distance());
    EXPECT_FALSE(checked.predicate("q").plain_distance());
}

// ---- horizons -----------------------------------------------------------------------------------

std::uint32_t horizon(const std::string& formula) {
    const Checked checked = monitor(formula, true);
    EXPECT_TRUE(checked.model) << checked.diagnostics();
    return checked.model ? checked.monitor("m").horizon : kUnbounded;
}

TEST(Horizon, IsTheSumAlongTheDeepestPath) {
    EXPECT_EQ(horizon("p"), 0U);
    EXPECT_EQ(horizon("G[0, 20] p"), 20U);
    EXPECT_EQ(horizon("X X p"), 2U);
    EXPECT_EQ(horizon("F[1, 3] G[2, 5] p && X q"), 8U);
    EXPECT_EQ(horizon("p U[0, 4] X q"), 5U);
    EXPECT_EQ(horizon("F[0, 7] p R[1, 4] q"), 11U);
    EXPECT_EQ(horizon("O[0, 100] F[0, 3] p"), 3U);
    EXPECT_EQ(horizon("H p && Y F[2, 2] (p S X q)"), 3U);
    EXPECT_EQ(horizon("G[0, 2147483646] p"), 2147483646U);
}

// ---- constancy ----------------------------------------------------------------------------------

/// Formulas called constant are +inf or -inf in the reference, on prefixes of random traces.
TEST(Constancy, HoldsInTheReference) {
    RandomFormulas random(5);
    std::mt19937 values(6);
    int constant = 0;
    for (int i = 0; i < 600; ++i) {
        const Checked checked = monitor(random.formula(3));
        if (!checked.model) continue;
        const Index root = checked.monitor("m").formula;
        const Constancy found = constancies(*checked.model)[root].at_start;
        if (found == Constancy::varies) continue;
        ++constant;
        reference::Trace trace;
        for (int k = 0; k < 6; ++k)
            trace.push_back(
                {{static_cast<double>(values() % 5) - 1.5}, {static_cast<double>(values() % 2)}});
        for (const auto& verdicts : reference::evaluate(*checked.model, trace).verdicts) {
            const double expected = found == Constancy::always ? INFINITY : -INFINITY;
            EXPECT_EQ(verdicts[0].robustness, expected) << checked.formula("m");
        }
    }
    EXPECT_GT(constant, 50);
}

/// Operators over constants that never change on short traces of the reference are all called
/// constant.
TEST(Constancy, FindsConstantsThatNoInputEnters) {
    EXPECT_EQ(monitor("true U p").codes(), "W0201 W0201");
    for (const char* formula :
         {"true", "p || F true", "G true", "false U p && false", "Y p", "H[1, 3] p", "p R true",
          "p W true", "true W p", "!(O[1, 1] p)", "p S[1, 2] q", "(false S[1, 2] p) && q",
          "true <-> G true", "p -> true", "rise p", "F fall true", "held[1] p", "count(p, 3) >= 1",
          "fraction(p, 3) > 0.5"})
        EXPECT_NE(monitor(formula).codes().find("W0503"), std::string::npos) << formula;
    for (const char* formula :
         {"F[1, inf] true", "X true", "p", "G (O[1, 1] true)", "F p", "p <-> q", "F held[1] true",
          "held[0] p", "F rise p", "F count(p, 3) >= 1", "fraction(p, 3) > 0",
          "F fraction(p, 3) > 0.5"})
        EXPECT_EQ(monitor(formula).codes().find("W0503"), std::string::npos) << formula;
}

// ---- comparisons and constants

TEST(Comparisons, OfTwoExpressionsAreOfTheirDifference) {
    EXPECT_EQ(canonical("x >= 2 * x"), "x - 2 * x >= 0");
    EXPECT_EQ(canonical("x - 1 < abs(x)"), "x - 1 - abs(x) < 0");
    EXPECT_EQ(canonical("x > -2"), "x > -2");
    EXPECT_EQ(canonical("0.5 >= x"), "x <= 0.5");
    EXPECT_EQ(canonical("-1 != -x"), "-x != -1");
    EXPECT_EQ(canonical("x == x + 1"), "x - (x + 1) == 0");
    EXPECT_EQ(canonical("1 < 2"), "1 < 2");
}

/// At the threshold itself all others are 0, and satisfied both plain and negated.
TEST(Comparisons, EqualityIsYesOrNo) {
    const std::vector<double> samples{-1, 0, 0.5, 1, NAN};
    const auto robustness = [&](const std::string& formula) {
        const Checked checked = monitor(formula, true);
        EXPECT_TRUE(checked.model) << checked.diagnostics();
        reference::Trace trace;
        for (const double x : samples) trace.push_back({{x}, {1}});
        std::vector<double> result;
        for (const auto& verdicts : reference::evaluate(*checked.model, trace).verdicts)
            result.push_back(verdicts[0].robustness);
        return result;
    };
    constexpr double kNo = -INFINITY;
    constexpr double kYes = INFINITY;
    EXPECT_EQ(robustness("x == 0.5"), (std::vector{kNo, kNo, kYes, kNo, kNo}));
    EXPECT_EQ(robustness("x != 0.5"), (std::vector{kYes, kYes, kNo, kYes, kNo}));
    EXPECT_EQ(robustness("!(x == 0.5)"), (std::vector{kYes, kYes, kNo, kYes, kNo}));
    EXPECT_EQ(robustness("x == abs(x)"), (std::vector{kNo, kYes, kYes, kYes, kNo}));
    EXPECT_EQ(robustness("x == 0.5 -> x > 2"), (std::vector{kYes, kYes, -1.5, kYes, kNo}));
}

TEST(Comparisons, EqualityThatNothingChanges) {
    const auto codes = [](const std::string& comparison) {
        return Checked("spec t; input x : f32 in [0, 2]; monitor m = G " + comparison + ";")
            .codes();
    };
    EXPECT_EQ(codes("x == 3"), "W0301");
    EXPECT_EQ(codes("x != 3"), "W0301");
    EXPECT_EQ(codes("x == 1"), "");
    EXPECT_EQ(codes("x != 2"), "");
}

/// Replaces `%` by a constant, or by its value.
std::string with_constants(const std::string& text, bool named) {
    const std::vector<std::pair<char, std::string>> values{
        {'D', "2"}, {'n', "3"}, {'k', "0.5"}, {'T', "0.3 s"}, {'r', "10"}};
    std::string result = "spec t;";
    for (const auto& [name, value] : values)
        if (named) result += fmt::format("const {} = {};", name, value);
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '%') {
            result += text[i];
            continue;
        }
        const char name = text[++i];
        for (const auto& [constant, value] : values)
            if (constant == name) result += named ? std::string(1, name) : value;
    }
    return result;
}

TEST(Constants, StandForTheirNumbers) {
    const std::string text =
        "rate %r Hz; input z : f32[%D] hold %n steps; input b : i8[%D] scale %k;"
        "input x : f32 in [-%n, %n]; target s = [[%k, -%k], [%n, %D]];"
        "predicate near = kth(%D) mahalanobis([%n, %D])(z, s) <= %k;"
        "predicate far = min l2(b, s) >= calibrated(conformal, alpha = %k);"
        "monitor m = G[0, %n min] near -> F[%T, inf] (far && x * %n > -%k && -%k <= x);";
    Options options;
    options.allow_uncalibrated = true;
    const Checked named(with_constants(text, true), options);
    const Checked plain(with_constants(text, false), options);
    ASSERT_TRUE(named.model) << named.diagnostics();
    ASSERT_TRUE(plain.model) << plain.diagnostics();
    EXPECT_EQ(named.codes(), "");
    EXPECT_EQ(named.formula("m"), plain.formula("m"));
    for (std::size_t i = 0; i < plain.model->inputs.size(); ++i) {
        EXPECT_EQ(named.model->inputs[i].dimension, plain.model->inputs[i].dimension);
        EXPECT_EQ(named.model->inputs[i].scale, plain.model->inputs[i].scale);
        EXPECT_EQ(named.model->inputs[i].hold, plain.model->inputs[i].hold);
        EXPECT_EQ(named.model->inputs[i].range.low, plain.model->inputs[i].range.low);
    }
    EXPECT_EQ(named.model->targets[0].hash, plain.model->targets[0].hash);
    ASSERT_EQ(named.model->predicates.size(), plain.model->predicates.size());
    for (std::size_t i = 0; i < plain.model->predicates.size(); ++i)
        EXPECT_EQ(named.model->predicates[i].text + named.model->predicates[i].threshold.text,
                  plain.model->predicates[i].text + plain.model->predicates[i].threshold.text);
    EXPECT_EQ(named.model->step_seconds, 0.1);
}

}  // namespace
}  // namespace etlc::check
