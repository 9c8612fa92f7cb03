// Compares truths, frame by frame, and the ground-truth monitor with the reference.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "episodes/truth.hpp"
#include "loading.hpp"
#include "random.hpp"
#include "reference/reference.hpp"

namespace etlc::tests {
namespace {

using episodes::Label;

/// Returns a formula of past operators over a, b and two comparisons.
std::string past_formula(Random& random, int depth) {
    if (depth == 0)
        return random.word({"a", "b", "(x > 0.375)", "(l2([x, y], goal) < 0.6875)",
                            "(mean(y, 4 steps) + x@3 <= 0.28125)",
                            "(max(l1([x, y], goal), 3 steps) < 1.125)",
                            "(min(x - y@1, 2 steps) > mean(x, 2 steps) + 0.0625)",
                            "(abs(mean(1 / y, 2 steps)) < 3.125)"});
    const auto operand = [&] {
        return "(" + past_formula(random, random.between(0, depth - 1)) + ")";
    };
    const auto interval = [&] {
        const int low = random.between(0, 3);
        return random.word({"", fmt::format("[{}, {}]", low, low + random.between(0, 3)),
                            fmt::format("[{}, inf]", low)});
    };
    switch (random.between(0, 12)) {
        case 0: return operand() + " && " + operand();
        case 1: return operand() + " || " + operand();
        case 2: return operand() + " -> " + operand();
        case 3: return operand() + " <-> " + operand();
        case 4: return "! " + operand();
        case 5: return "O" + interval() + " " + operand();
        case 6: return "H" + interval() + " " + operand();
        case 7: return "Y " + operand();
        case 8: return random.word({"rise ", "fall "}) + operand();
        case 10:
            return fmt::format("count({}, {} steps) >= {}", operand(), random.between(5, 7),
                               random.between(1, 3));
        case 11:
            return fmt::format("fraction({}, {} steps) >= 0.{}", operand(), random.between(1, 5),
                               random.between(1, 9));
        case 9: return fmt::format("held[{}] ", random.between(0, 3)) + operand();
        default: return operand() + " S" + interval() + " " + operand();
    }
}

episodes::Frame random_frame(Random& random) {
    episodes::Frame frame;
    for (int i = 0; i < 2; ++i)
        frame.push_back(random.chance(0.15) ? std::vector<double>{}
                                            : std::vector<double>{random.between(0, 1) + 0.0});
    for (int i = 0; i < 2; ++i)
        frame.push_back(random.chance(0.15) ? std::vector<double>{}
                                            : std::vector<double>{random.grid(-1, 1, 0.25)});
    return frame;
}

Label label_of(reference::Status status) {
    if (status == reference::Status::satisfied) return Label::yes;
    return status == reference::Status::violated ? Label::no : Label::unknown;
}

TEST(Truth, IsWhatTheReferenceSaysOfEveryFrame) {
    Random random(20261120);
    for (int spec = 0; spec < 400; ++spec) {
        const std::string text = fmt::format(
            "spec t; input a, b : bool; input x : f32 in [-0.75, 1]; input y : f32 hold 1, stale "
            "after 1; target "
            "goal = [[0.5, 0.5]];\n"
            "sliding monitor m = {};",
            past_formula(random, 4));
        const auto model = load(text);
        ASSERT_TRUE(model) << text;
        const check::Index formula = model->monitors[0].formula;
        episodes::TruthEvaluator truth(*model, {formula});
        reference::Trace trace;
        for (int t = 0; t < 16; ++t) trace.push_back(random_frame(random));
        const reference::Run run = reference::evaluate(*model, trace);
        for (int episode = 0; episode < 2; ++episode) {  // a reset forgets the past
            truth.reset();
            for (std::size_t t = 0; t < trace.size(); ++t) {
                truth.step(trace[t]);
                ASSERT_EQ(truth[formula], label_of(run.verdicts[t][0].status))
                    << text << " at " << t;
            }
        }
    }
}

Label single(const std::string& comparison, double x) {
    const auto model = load(
        fmt::format("spec t; input x : f32; input z : i8[2] scale 0.25; target g = [[0, 0.25]];\n"
                    "sliding monitor m = {};",
                    comparison));
    episodes::TruthEvaluator truth(*model, {model->monitors[0].formula});
    truth.step({{x}, {0, 2}});
    return truth[model->monitors[0].formula];
}

TEST(Truth, ComparesDoublesExactly) {
    // 0.1 and its nearest float32 are different numbers; so are 0.25 and the double below it.
    EXPECT_EQ(single("x <= 0.1", 0.1), Label::yes);
    EXPECT_EQ(single("x < 0.1", 0.1), Label::no);
    EXPECT_EQ(single("x >= 0.1", 0.1), Label::yes);
    EXPECT_EQ(single("x > 0.1", 0.1), Label::no);
    EXPECT_EQ(single("x < 0.1", static_cast<double>(0.1F)), Label::no);
    EXPECT_EQ(single("x < 0.25", std::nextafter(0.25, 0.0)), Label::yes);
    EXPECT_EQ(single("0 / x > 1", 0), Label::unknown);
    EXPECT_EQ(single("l1(z, g) <= 0.25", 0), Label::yes);  // the integers 0 and 2 become 0 and 0.5
    EXPECT_EQ(single("l1(z, g) < 0.25", 0), Label::no);
    EXPECT_EQ(single("x > 1", 1e39),
              Label::unknown);  // not a float32: the monitor treats it as missing
}

/// A sum of floats of any size and sign is exact, so nothing is left of what has gone.
TEST(Truth, MeansForgetWhatIsGone) {
    const auto model = load("spec t; input x : f32; sliding monitor m = mean(x, 3 steps) >= 1e-3;");
    const check::Index formula = model->monitors[0].formula;
    episodes::TruthEvaluator truth(*model, {formula});
    Label last = Label::unknown;
    for (const double x : {1e30, 1e-20, -1e30, 3e-3}) truth.step({{x}}), last = truth[formula];
    EXPECT_EQ(last, Label::no);  // (1e-20 - 1e30 + 3e-3) / 3
    for (const double x : {1e-20, 2.9e-3}) truth.step({{x}}), last = truth[formula];
    EXPECT_EQ(last, Label::yes);
    truth.step({{1e-20}});
    EXPECT_EQ(truth[formula], Label::no);
}

TEST(Truth, DistancesInDouble) {
    const std::vector<std::string> metrics{"l2",
                                           "l2sq",
                                           "l1",
                                           "linf",
                                           "cosine",
                                           "angular",
                                           "mahalanobis([[2, 1], [1, 3]])",
                                           "mahalanobis([2, 3])"};
    const std::vector<std::string> aggregations{"min", "max", "mean", "kth(2)"};
    Random random(5);
    for (const std::string& metric : metrics) {
        for (const std::string& aggregation : aggregations) {
            const auto model =
                load(fmt::format("spec t; input z : f32[2]; target g = [[1, 0], [0.5, 0.5], [-1, "
                                 "2]];\nmonitor m = {} {}(z, g) <= 1;",
                                 aggregation, metric));
            ASSERT_TRUE(model);
            for (int i = 0; i < 20; ++i) {
                const std::vector<double> z{random.grid(-2, 2, 0.125), random.grid(-2, 2, 0.125)};
                const auto run = reference::evaluate(*model, {{z}});
                const auto delta = episodes::exact_distance(*model, model->distances[0], z);
                const double expected = run.telemetry[0][0].delta;
                ASSERT_EQ(delta.has_value(), expected == expected) << metric;
                if (!delta) continue;
                ASSERT_NEAR(*delta, expected, 1e-14 * (1 + expected))
                    << metric << " " << aggregation;
            }
        }
    }
}

TEST(GroundTruth, ReplacesLabelledPredicatesOnly) {
    const auto model = load(
        "spec t; input x, y, px : f32;\n"
        "predicate p = x <= 1; predicate q = y <= 1; truth p = px <= 0;\n"
        "monitor m = F (p && q); monitor n = G !p;");
    ASSERT_TRUE(model);
    const episodes::GroundTruth truth = episodes::ground_truth(*model, {0});
    ASSERT_EQ(truth.model.inputs.size(), 4U);
    EXPECT_EQ(truth.inputs[0], 3U);
    EXPECT_EQ(truth.inputs[1], check::kNone);
    EXPECT_EQ(check::print(truth.model, truth.model.monitors[0].formula), "F (truth.p && q)");
    EXPECT_EQ(check::print(truth.model, truth.model.monitors[1].formula), "G !truth.p");
    // x and y give p && q; the label first disagrees, then agrees, then is missing.
    const auto step = [](std::vector<double> label) {
        return reference::Step{{0.0}, {0.0}, {0.0}, std::move(label)};
    };
    const reference::Run run = reference::evaluate(truth.model, {step({0}), step({1}), step({})});
    EXPECT_EQ(run.verdicts[0][0].status, reference::Status::violated);
    EXPECT_EQ(run.verdicts[1][0].status, reference::Status::satisfied);
    EXPECT_EQ(run.verdicts[0][1].status, reference::Status::satisfied);
    EXPECT_EQ(run.verdicts[1][1].status, reference::Status::violated);
    EXPECT_EQ(episodes::sample_of(Label::yes).values, std::vector<float>{1});
    EXPECT_EQ(episodes::sample_of(Label::no).values, std::vector<float>{0});
    EXPECT_FALSE(episodes::sample_of(Label::unknown).present);
}

}  // namespace
}  // namespace etlc::tests
