// Tests ranges of expressions: random samples stay inside.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "check/numbers/range.hpp"
#include "checking.hpp"

namespace etlc::check {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();

/// Computes in float32, one operation at a time.
float value_of(const Expr& e, const std::vector<float>& inputs) {
    std::vector<float> a;
    for (const Expr& argument : e.arguments) a.push_back(value_of(argument, inputs));
    for (const float argument : a)
        if (std::isnan(argument)) return argument;  // NaN stays NaN, also under min and max
    switch (e.kind) {
        case Expr::Kind::number: return e.number32;
        case Expr::Kind::scalar: return inputs[e.index];
        case Expr::Kind::distance: break;
        case Expr::Kind::past: return a[0];  // where the inputs stay the same
        case Expr::Kind::negate: return -a[0];
        case Expr::Kind::add: return a[0] + a[1];
        case Expr::Kind::subtract: return a[0] - a[1];
        case Expr::Kind::multiply: return a[0] * a[1];
        case Expr::Kind::divide: return a[0] / a[1];
        case Expr::Kind::abs: return std::abs(a[0]);
        case Expr::Kind::sqrt: return std::sqrt(a[0]);
        case Expr::Kind::min: return *std::min_element(a.begin(), a.end());
        case Expr::Kind::max: return *std::max_element(a.begin(), a.end());
    }
    return 0;
}

class RandomExpressions {
public:
    explicit RandomExpressions(unsigned seed) : random_(seed) {}

    std::string expression(int depth) {
        if (depth == 0 || below(6) == 0) return leaf();
        const std::string a = expression(depth - 1);
        switch (below(11)) {
            case 0: return fmt::format("({} + {})", a, expression(depth - 1));
            case 1: return fmt::format("({} - {})", a, expression(depth - 1));
            case 2:
            case 3: return fmt::format("({} * {})", a, expression(depth - 1));
            case 4: return fmt::format("({} / {})", a, expression(depth - 1));
            case 5: return fmt::format("abs({})", a);
            case 6: return fmt::format("sqrt({})", a);
            case 7: return fmt::format("min({}, {})", a, expression(depth - 1));
            case 8: return fmt::format("({})@2", a);
            case 9: return fmt::format("mean({}, 3 steps)", a);
            default: return fmt::format("max({}, {}, -{})", a, expression(depth - 1), leaf());
        }
    }

    /// Ends are likely, since they give the extremes.
    float sample(const Range& range) {
        const float low = std::max(range.low, -std::numeric_limits<float>::max());
        const float high = std::min(range.high, std::numeric_limits<float>::max());
        if (below(4) == 0) return low;
        if (below(4) == 0) return high;
        const double t = std::uniform_real_distribution<double>(0, 1)(random_);
        const auto value =
            static_cast<float>(static_cast<double>(low) * (1 - t) + static_cast<double>(high) * t);
        return std::clamp(value, low, high);
    }

private:
    int below(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }

    std::string leaf() {
        static const std::vector<std::string> leaves{"x", "y",     "v",    "w",          "0.1",
                                                     "3", "1e-30", "7e20", "0.333333333"};
        return leaves[random_() % leaves.size()];
    }

    std::mt19937 random_;
};

TEST(Ranges, RandomSamplesStayInside) {
    RandomExpressions random(11);
    int checked_samples = 0;
    for (int i = 0; i < 400; ++i) {
        const std::string text = random.expression(4);
        const Checked checked(
            "spec t; input x : f32 in [-3.7, 2.3]; input y : f32 in [0.1, 5]; input v : f32 in "
            "[1e-20, 1e20]; input w : f32;"
            "predicate p = " +
            text + " <= 0.7; monitor m = G p;");
        ASSERT_TRUE(checked.model) << checked.diagnostics();
        const Predicate& p = checked.model->predicates[0];
        ASSERT_LE(p.delta.low, p.delta.high);
        for (int k = 0; k < 200; ++k) {
            std::vector<float> inputs;
            for (const Input& input : checked.model->inputs)
                inputs.push_back(random.sample(input.range));
            const float delta = value_of(p.expression, inputs);
            if (std::isnan(delta)) continue;  // unknown
            ++checked_samples;
            EXPECT_TRUE(p.delta.contains(delta))
                << text << ": " << delta << " in [" << p.delta.low << ", " << p.delta.high << "]";
            EXPECT_TRUE(p.robustness.contains(p.threshold.value - delta)) << text;
        }
    }
    EXPECT_GT(checked_samples, 40000);
}

Range range_of(const std::string& expression, const std::string& inputs) {
    const Checked checked("spec t; " + inputs + " predicate p = " + expression +
                          " <= 0.5; monitor m = G p;");
    EXPECT_TRUE(checked.model) << checked.diagnostics();
    return checked.model ? checked.model->predicates[0].delta : Range{};
}

void expect_range(const std::string& expression, float low, float high) {
    const Range range =
        range_of(expression,
                 "input x : f32 in [-2, 3]; input y : f32 in [1, 4]; input n : f32 in [0, inf]; "
                 "input u : f32;"
                 "input z : f32[2]; target t1 = [[1, 2]]; target t2 = [[2, 1], [1, 1]];");
    EXPECT_EQ(range.low, low) << expression;
    EXPECT_EQ(range.high, high) << expression;
}

TEST(Ranges, ByHand) {
    expect_range("x + y", -1, 7);
    expect_range("x - y", -6, 2);
    expect_range("-x", -3, 2);
    expect_range("x * x", -6, 9);  // interval arithmetic does not know that both are the same
    expect_range("x / y", -2, 3);
    expect_range("y / x", -kInf, kInf);
    expect_range("1 / n", -kInf, kInf);
    expect_range("n * 0", 0, 0);
    expect_range("n * x", -kInf, kInf);
    expect_range("y / (n + 1)", 0, 4);
    expect_range("abs(x)", 0, 3);
    expect_range("sqrt(y)", 1, 2);
    expect_range("sqrt(x)", 0,
                 std::nextafter(std::sqrt(3.0F), 2.0F));  // 1.73205078F is below the root
    expect_range("min(x, y)", -2, 3);
    expect_range("max(x, y, 2)", 2, 4);
    expect_range("u", -kInf, kInf);
    expect_range("abs(u)", 0, kInf);
}

TEST(Ranges, OfDistances) {
    for (const char* metric : {"l2", "l2sq", "l1", "linf", "mahalanobis([1, 2])"})
        expect_range(std::string(metric) + "(z, t1)", 0, kInf);
    for (const char* aggregation : {"min", "max", "mean", "kth(2)"})
        expect_range(std::string(aggregation) + " cosine(z, t2)", 0, 2);
    expect_range("angular(z, t1)", 0, 3.14159274F);
    EXPECT_GT(static_cast<double>(3.14159274F), 3.14159265358979323846);
    expect_range("cosine(z, t1) - min cosine(z, t2)", -2, 2);
    expect_range("l2(z, t1) - min l2(z, t2)", -kInf, kInf);
}

TEST(Ranges, OutwardWhereInexact) {
    const Range sum = range_of("x + 1e-9", "input x : f32 in [1, 2];");
    EXPECT_EQ(sum.low, 1.0F);
    EXPECT_EQ(sum.high, std::nextafter(2.0F, 3.0F));
    const Range tiny =
        range_of("x - 1e-40", "input x : f32 in [1, 2];");  // beyond the precision of a double for
                                                            // the sum
    EXPECT_EQ(tiny.low, std::nextafter(1.0F, 0.0F));
    const Range third = range_of("x / 3", "input x : f32 in [1, 1];");
    EXPECT_EQ(third.low, std::nextafter(1.0F / 3.0F, 0.0F));
    EXPECT_EQ(third.high, 1.0F / 3.0F);
    const Range huge = range_of("x * 1e30", "input x : f32 in [1, 1e30];");
    EXPECT_EQ(huge.high, kInf);
}

TEST(Ranges, OfRobustness) {
    const Checked checked(
        "spec t; input x : f32 in [0, 1]; predicate p = x <= 0.25; predicate q = x > 0.25; monitor "
        "m = G (p || q);");
    ASSERT_TRUE(checked.model) << checked.diagnostics();
    EXPECT_EQ(checked.predicate("p").robustness.low, -0.75F);
    EXPECT_EQ(checked.predicate("p").robustness.high, 0.25F);
    EXPECT_EQ(checked.predicate("q").robustness.low, -0.25F);
    EXPECT_EQ(checked.predicate("q").robustness.high, 0.75F);
}

}  // namespace
}  // namespace etlc::check
