// Compares the plan's evaluator, which `etlc run` steps, with the reference: every operator on all
// short traces, and random specs on random traces.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <ostream>
#include <string>

#include "compare.hpp"
#include "exhaustive.hpp"
#include "loading.hpp"
#include "plan_runner.hpp"
#include "random_spec.hpp"
#include "random_trace.hpp"
#include "restart_schedule.hpp"

namespace {

using namespace etlc;
using namespace etlc::tests;
using Formulas = SpecShape::Formulas;

/// Bound for distances that round: float32 sums of a few elements, against double; absolute for
/// |value| <= 1, relative above.
constexpr double kRounding = 1e-5;

void expect_agreement(const check::Model& model, PlanRunner& runner, const reference::Trace& trace,
                      double rounding) {
    const Observed observed = runner.run(trace);
    const auto mismatch =
        first_mismatch(model, expected_run(model, trace, observed), observed, {rounding});
    ASSERT_FALSE(mismatch) << *mismatch << "\n"
                           << model.file.text() << "\n"
                           << to_csv(model, trace);
}

void expect_agreement_on_all(const std::string& spec, std::size_t steps, bool gaps,
                             std::size_t inputs = 2) {
    const auto model = load(spec);
    ASSERT_TRUE(model);
    PlanRunner runner(*model, kRoomy);
    ASSERT_EQ(runner.refusal(), "");
    const AllTraces traces(steps, gaps, inputs);
    for (std::size_t n = 0; n < traces.size(); ++n) {
        expect_agreement(*model, runner, traces[n], 0);
        if (testing::Test::HasFatalFailure()) return;
    }
}

// The prefixes of a trace of six steps are the shorter traces.
TEST(PlanExhaustive, PrefixMonitors) {
    expect_agreement_on_all(exhaustive_spec(), 6, false);
}
TEST(PlanExhaustive, PrefixMonitorsWithGaps) {
    expect_agreement_on_all(exhaustive_spec(), 4, true);
}

TEST(PlanExhaustive, MonitorsThatRestart) {
    for (const char* kind : {"restartable monitor", "repeating monitor"}) {
        expect_agreement_on_all(exhaustive_spec("restarted", kind), 6, false);
        expect_agreement_on_all(exhaustive_spec("restarted", kind), 4, true);
    }
}

TEST(PlanExhaustive, Chains) {
    for (const char* kind : {"monitor", "restartable monitor", "repeating monitor"}) {
        expect_agreement_on_all(exhaustive_chains_spec("chains", kind), 5, false);
        expect_agreement_on_all(exhaustive_chains_spec("chains", kind), 3, true);
    }
}

/// Predicates over earlier numbers or earlier points.
class PastExhaustive : public testing::TestWithParam<bool> {};

TEST_P(PastExhaustive, OneInputWithGaps) {
    for (const char* more : {"", " hold 1", " hold 2, stale after 2"}) {
        const PastShape shape{.points = GetParam(), .of_inputs = more};
        expect_agreement_on_all(exhaustive_past_spec("earlier", shape), 6, true, 1);
    }
    for (const char* kind : {"restartable monitor", "repeating monitor"}) {
        const PastShape shape{.points = GetParam(), .kind = kind};
        expect_agreement_on_all(exhaustive_past_spec("earlier", shape), 6, true, 1);
    }
}

// Long enough for every ring to come round twice.
TEST_P(PastExhaustive, OneInput) {
    const PastShape shape{.points = GetParam()};
    expect_agreement_on_all(exhaustive_past_spec("earlier", shape), 10, false, 1);
}

TEST_P(PastExhaustive, TwoInputsWithGaps) {
    for (const char* more : {"", " hold 1"}) {
        const PastShape shape{.points = GetParam(), .inputs = 2, .of_inputs = more};
        expect_agreement_on_all(exhaustive_past_spec("earlier", shape), 4, true);
    }
}

// The verdicts of a prefix bound those of every continuation, whatever its samples are.
TEST_P(PastExhaustive, BoundsHoldForEveryContinuation) {
    for (const std::size_t inputs : {1, 2}) {
        const PastShape shape{.points = GetParam(), .inputs = inputs};
        const auto model = load(exhaustive_past_spec("earlier", shape));
        ASSERT_TRUE(model);
        PlanRunner runner(*model, kRoomy);
        for (std::uint64_t n = 0; n < 400; ++n) {
            reference::Trace trace = random_trace(*model, n / 20, {.steps = 1 + n / 20 % 6});
            const double missing = n % 3 == 0 ? 0.2 : 0;
            for (const reference::Step& step :
                 random_trace(*model, 1000 + n, {.steps = 6, .missing = missing, .extreme = 0.4}))
                trace.push_back(step);
            expect_agreement(*model, runner, trace, kRounding);
            if (HasFatalFailure()) return;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(NumbersAndPoints, PastExhaustive, testing::Bool(),
                         [](const auto& points) { return points.param ? "Points" : "Numbers"; });

/// Operations, bytes of state and bytes of code of a chain of p0, p1, ...
std::vector<std::uint64_t> cost_of_chain(const std::string& kind, int phases) {
    std::string spec = "spec long_chain;\n";
    std::vector<std::string> operands;
    for (int n = 0; n < phases; ++n) {
        spec += fmt::format("input x{0} : f32 in [-4, {1}]; predicate p{0} = x{0} > 0;\n", n,
                            1 + n % 8);
        operands.push_back(fmt::format("p{}", n));
    }
    const auto model = load(spec + "monitor m = " + chain(kind, operands) + ";");
    if (!model) return {};
    PlanRunner runner(*model, kRoomy);
    EXPECT_EQ(runner.refusal(), "") << kind << " of " << phases;
    if (!runner.refusal().empty()) return {};
    const plan::Cost& cost = runner.cost();
    return {cost.operations, cost.state_bytes, cost.code_bytes};
}

// Each further phase costs the same, whatever their number.
TEST(Chains, CostInProportionToTheirPhases) {
    for (const std::string& kind : chain_kinds()) {
        const auto of_32 = cost_of_chain(kind, 32);
        const auto of_64 = cost_of_chain(kind, 64);
        ASSERT_FALSE(of_32.empty() || of_64.empty());
        for (const int phases : {96, 128, 256}) {
            if (phases == 256 && kind == "U and X") continue;                  // nests too deep
            if (phases > 96 && kind.find(" in turn") < kind.size()) continue;  // likewise
            std::vector<std::uint64_t> expected;
            for (std::size_t n = 0; n < of_32.size(); ++n)
                expected.push_back(of_32[n] + (phases / 32 - 1) * (of_64[n] - of_32[n]));
            EXPECT_EQ(cost_of_chain(kind, phases), expected) << kind << " of " << phases;
        }
    }
}

/// Operations of a formula over `{0}`, `{1}`, ...
std::uint64_t operations_of(const std::string& formula, int phases) {
    std::string spec = "spec s;\n";
    for (int n = 0; n <= phases; ++n)
        spec += fmt::format("input x{0} : f32 in [-4, {1}]; predicate p{0} = x{0} > 0;\n", n,
                            1 + n % 8);
    const auto model = load(spec + "monitor m = " + formula + ";");
    if (!model) return 0;
    PlanRunner runner(*model, {});
    EXPECT_EQ(runner.refusal(), "") << formula;
    return runner.refusal().empty() ? runner.cost().operations : 0;
}

/// Returns p0 and, within `steps` of it, p1 and so on; by && or, in the dual, by ||.
std::string in_time(const std::string& op, int phases, int steps) {
    std::string rest = fmt::format("p{}", phases - 1);
    for (int n = phases - 1; n-- > 0;)
        rest = fmt::format("(p{} {} {}[0, {}] {})", n, op == "G" ? "||" : "&&", op, steps, rest);
    return rest;
}

TEST(Chains, WithTimesCostWhatTheirPhasesCost) {
    for (const char* op : {"F", "G"}) {
        const auto whole = [&](int phases, int steps) {
            return fmt::format("{}[0, {}] {}", op, steps + 20, in_time(op, phases, steps));
        };
        EXPECT_LE(operations_of(whole(4, 80), 4), 80) << op;
        EXPECT_LE(operations_of(whole(12, 240), 12), 260) << op;
    }
    EXPECT_LE(operations_of("p4 U[0, 100] " + in_time("F", 4, 80), 4), 80);
    EXPECT_LE(operations_of("p12 U[0, 260] " + in_time("F", 12, 240), 12), 260);
}

TEST(Chains, AnswersAndUntilsInTurnCostWhatTheirPhasesCost) {
    for (const int phases : {8, 32, 128}) {
        std::vector<std::string> operands;
        for (int n = 1; n <= phases; ++n) operands.push_back(fmt::format("p{}", n));
        EXPECT_LE(operations_of("G (p0 -> " + chain("F", operands) + ")", phases), 10 * phases);
    }
    std::string until = "p8 U p9";
    for (int n = 8; n > 0; n -= 2) until = fmt::format("p{} U (({}) U p{})", n - 2, until, n - 1);
    EXPECT_LE(operations_of(until, 9), 200);
}

// The generated class assigned a member to itself, about which clang warns.
TEST(Chains, WaysThatAreNeverDoneAreNotStored) {
    const auto model = load(
        "spec s; input a : bool; input b : bool; input c : bool;\n"
        "monitor m = (c && a) R (G b);");
    ASSERT_TRUE(model);
    PlanRunner runner(*model, {});
    ASSERT_EQ(runner.refusal(), "");
    EXPECT_EQ(runner.text().find("is pending"), std::string::npos) << runner.text();
}

// For sliding monitors the end of the trace matters too.
TEST(PlanExhaustive, SlidingMonitors) {
    for (std::size_t steps = 1; steps <= 6; ++steps)
        expect_agreement_on_all(exhaustive_sliding_spec(), steps, false);
}
TEST(PlanExhaustive, SlidingMonitorsWithGaps) {
    for (std::size_t steps = 1; steps <= 4; ++steps)
        expect_agreement_on_all(exhaustive_sliding_spec(), steps, true);
}

/// F[a,b] (g && F[c,d] h), alone and as the response of G, and the duals, with all of these
/// intervals, over predicates with different ranges. Their state machines would exceed these
/// limits.
class PlanInTwoParts : public testing::TestWithParam<const char*> {};

TEST_P(PlanInTwoParts, TakesFewOperations) {
    const plan::Limits few_operations{.operations = 300};
    const auto spec = [](const std::string& formula) {
        return fmt::format(
            "spec two; input x, y, z : f32 in [-4, 4]; predicate p = x >= -1; predicate q = y > 1;"
            "predicate r = z <= 0; {} m = {};",
            GetParam(), formula);
    };
    int seed = 0;
    for (const char* begun : {"[0, 12]", "[9, 9]", "[4, 20]"})
        for (const char* done : {"[0, 9]", "[0, 16]", "[5, 12]", "[12, 12]"})
            for (const char* form :
                 {"G F{} (p && F{} q)", "G (r -> F{} (p && F{} q))", "F G{} (q || G{} p)",
                  "G[2, 30] (r || F{} (p && O[0, 2] r && F{} q))",
                  "F[1, 40] (r && G{} (p || G{} q))", "F{} (p && F{} q)",
                  "G{} (q || r || G{} p)"}) {
                const auto model = load(spec(fmt::format(fmt::runtime(form), begun, done)));
                ASSERT_TRUE(model);
                PlanRunner runner(*model, few_operations);
                ASSERT_EQ(runner.refusal(), "") << model->file.text();
                for (const double missing : {0.0, 0.0, 0.1, 0.4}) {
                    const TraceShape shape{.steps = 60, .missing = missing};
                    expect_agreement(*model, runner, random_trace(*model, ++seed, shape), 0);
                    if (HasFatalFailure()) return;
                }
            }
}

INSTANTIATE_TEST_SUITE_P(Kinds, PlanInTwoParts, testing::Values("monitor", "repeating monitor"));

/// Samples that repeat, differ or are missing, in all sequences of seven.
TEST(PlanExhaustive, StaleSamples) {
    constexpr std::size_t kSteps = 7;
    for (const char* after : {"", ", stale after 1", ", stale after 2", ", stale after 3"})
        for (const char* hold : {"", " hold 1", " hold 2"}) {
            const auto model = load(
                fmt::format("spec s; input x : f32{}{}; sliding monitor m = x > 1;", hold, after));
            ASSERT_TRUE(model);
            PlanRunner runner(*model, kRoomy);
            for (std::size_t n = 0; n < 4 * 4 * 4 * 4 * 4 * 4 * 4; ++n) {
                const reference::Step samples[] = {{{}}, {{1}}, {{2}}, {{9.5}}};
                reference::Trace trace;
                for (std::size_t step = 0, rest = n; step < kSteps; ++step, rest /= 4)
                    trace.push_back(samples[rest % 4]);
                expect_agreement(*model, runner, trace, 0);
                if (HasFatalFailure()) return;
            }
        }
}

struct RandomCase {
    const char* name;
    SpecShape shape;
    int specs;
    double refused = 0;  ///< greatest fraction of specs that may be refused for their size
    bool retargetable = false;
};

void PrintTo(const RandomCase& random, std::ostream* out) {
    *out << random.name;
}

/// Factor on the number of random specs; ETLC_EFFORT=100 for a night.
int effort() {
    const char* text = std::getenv("ETLC_EFFORT");
    return text == nullptr ? 1 : std::max(1, std::atoi(text));
}

class PlanRandom : public testing::TestWithParam<RandomCase> {};

TEST_P(PlanRandom, AgreesWithTheReference) {
    const RandomCase& random = GetParam();
    const int specs = random.specs * effort();
    int refused = 0;
    for (int n = 0; n < specs; ++n) {
        const std::string spec = random_spec(n, random.shape);
        const auto model = random.retargetable ? load_retargetable(spec) : load(spec);
        ASSERT_TRUE(model);
        PlanRunner runner(*model, kRoomy);
        if (!runner.refusal().empty() && ++refused <= random.refused * specs) continue;
        ASSERT_EQ(runner.refusal(), "") << model->file.text();
        for (int t = 0; t < 6; ++t) {
            TraceShape shape{.steps = static_cast<std::size_t>(5 + 9 * t),
                             .grid = random.shape.exact};
            if (t % 3 > 0) shape.missing = 0.1 * t;
            if (t % 3 > 1) shape.invalid = 0.1;
            expect_agreement(*model, runner, random_trace(*model, 100 * n + t, shape),
                             random.shape.exact ? 0 : kRounding);
            if (HasFatalFailure()) return;
        }
    }
}

const RandomCase kCases[] = {
    {"Unnested", {.formulas = Formulas::unnested, .depth = 3}, 80},
    {"UnnestedRounded", {.formulas = Formulas::unnested, .depth = 2, .exact = false}, 40},
    {"UnboundedNesting", {.formulas = Formulas::unbounded_nesting, .monitors = 4, .depth = 3}, 80},
    {"Prefix", {.formulas = Formulas::prefix, .monitors = 4, .depth = 3, .window = 3}, 120},
    {"PrefixRounded",
     {.formulas = Formulas::prefix, .monitors = 4, .depth = 2, .exact = false},
     40},
    {"Sliding", {.formulas = Formulas::sliding, .depth = 4, .window = 3}, 100},
    {"Mixed", {.formulas = Formulas::mixed, .monitors = 6, .depth = 3, .window = 3}, 60},
    {"PrefixDeep", {.formulas = Formulas::prefix, .monitors = 2, .depth = 5, .window = 6}, 40, 0.1},
    {"PrefixLongWindows",
     {.formulas = Formulas::prefix, .monitors = 2, .depth = 3, .window = 25},
     60,
     0.1},
    {"SlidingLongWindows",
     {.formulas = Formulas::sliding, .monitors = 2, .depth = 3, .window = 15},
     40},
    {"Restarts",
     {.formulas = Formulas::prefix, .monitors = 4, .depth = 3, .window = 5, .restarts = 1},
     100},
    {"MissingCounts",
     {.formulas = Formulas::mixed,
      .monitors = 4,
      .depth = 3,
      .window = 4,
      .restarts = 0.5,
      .missing = 0.6},
     80},
    {"Retargetable",
     {.formulas = Formulas::mixed, .monitors = 4, .depth = 3, .window = 4, .restarts = 0.3},
     80,
     0.1,
     true},
    {"Chains",
     {.formulas = Formulas::chains, .monitors = 3, .depth = 40, .restarts = 0.5, .missing = 0.3},
     80,
     0.05},
    {"ShortChains",
     {.formulas = Formulas::chains, .monitors = 6, .depth = 5, .restarts = 0.3, .missing = 0.3},
     80},
    {"Sequences",
     {.formulas = Formulas::sequences,
      .monitors = 4,
      .depth = 4,
      .window = 20,
      .restarts = 0.5,
      .missing = 0.3},
     80,
     0.1},
    {"SlidingRounded", {.formulas = Formulas::sliding, .depth = 2, .exact = false}, 40},
};

INSTANTIATE_TEST_SUITE_P(Shapes, PlanRandom, testing::ValuesIn(kCases),
                         [](const auto& shape) { return std::string(shape.param.name); });

}  // namespace
