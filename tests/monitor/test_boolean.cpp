// Tests `--values boolean`: compares the plan's evaluator on truth values with the reference, where
// comparisons decide exactly.
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
using check::Values;
using Formulas = SpecShape::Formulas;

void expect_agreement(const check::Model& model, PlanRunner& runner,
                      const reference::Trace& trace) {
    const Observed observed = runner.run(trace);
    const auto mismatch =
        first_mismatch(model, expected_run(model, trace, observed, Values::boolean), observed, {});
    ASSERT_FALSE(mismatch) << *mismatch << "\n"
                           << model.file.text() << "\n"
                           << to_csv(model, trace);
}

TEST(BooleanExhaustive, PrefixAndSlidingMonitorsWithGaps) {
    for (const std::string& spec :
         {exhaustive_spec(), exhaustive_sliding_spec(), exhaustive_chains_spec()}) {
        const auto model = load(spec);
        ASSERT_TRUE(model);
        PlanRunner runner(*model, kRoomy, Values::boolean);
        ASSERT_EQ(runner.refusal(), "");
        const AllTraces traces(4, true);
        for (std::size_t n = 0; n < traces.size(); ++n) {
            expect_agreement(*model, runner, traces[n]);
            if (HasFatalFailure()) return;
        }
    }
}

TEST(BooleanExhaustive, EarlierNumbersAndPointsWithGaps) {
    for (const bool points : {false, true})
        for (const char* kind : {"monitor", "repeating monitor"})
            for (const std::size_t inputs : {1, 2}) {
                const auto model = load(exhaustive_past_spec(
                    "earlier", {.points = points, .inputs = inputs, .kind = kind}));
                ASSERT_TRUE(model);
                PlanRunner runner(*model, kRoomy, Values::boolean);
                ASSERT_EQ(runner.refusal(), "");
                const AllTraces traces(inputs == 1 ? 6 : 3, true, inputs);
                for (std::size_t n = 0; n < traces.size(); ++n) {
                    expect_agreement(*model, runner, traces[n]);
                    if (HasFatalFailure()) return;
                }
            }
}

struct RandomCase {
    const char* name;
    SpecShape shape;
    int specs;
};

void PrintTo(const RandomCase& random, std::ostream* out) {
    *out << random.name;
}

int effort() {
    const char* text = std::getenv("ETLC_EFFORT");
    return text == nullptr ? 1 : std::max(1, std::atoi(text));
}

class BooleanRandom : public testing::TestWithParam<RandomCase> {};

// Numbers are on a grid: distances often equal their thresholds, where < and <= differ.
TEST_P(BooleanRandom, AgreesWithTheReference) {
    const RandomCase& random = GetParam();
    for (int n = 0; n < random.specs * effort(); ++n) {
        const auto model = load(random_spec(40000 + n, random.shape));
        ASSERT_TRUE(model);
        PlanRunner runner(*model, kRoomy, Values::boolean);
        if (!runner.refusal().empty()) continue;
        for (int t = 0; t < 6; ++t) {
            TraceShape shape{.steps = static_cast<std::size_t>(5 + 9 * t), .grid = true};
            if (t % 3 > 0) shape.missing = 0.1 * t;
            if (t % 3 > 1) shape.invalid = 0.1;
            expect_agreement(*model, runner, random_trace(*model, 100 * n + t, shape));
            if (HasFatalFailure()) return;
        }
    }
}

const RandomCase kCases[] = {
    {"Unnested", {.formulas = Formulas::unnested, .depth = 3}, 60},
    {"Prefix", {.formulas = Formulas::prefix, .monitors = 4, .depth = 3, .window = 3}, 60},
    {"Sliding", {.formulas = Formulas::sliding, .depth = 4, .window = 3}, 60},
    {"Mixed", {.formulas = Formulas::mixed, .monitors = 6, .depth = 3, .window = 3}, 40},
    {"Restarts",
     {.formulas = Formulas::mixed,
      .monitors = 6,
      .depth = 3,
      .window = 4,
      .restarts = 0.8,
      .missing = 0.3},
     60},
    {"Chains",
     {.formulas = Formulas::chains, .monitors = 3, .depth = 40, .restarts = 0.5, .missing = 0.3},
     60},
    {"Sequences",
     {.formulas = Formulas::sequences, .monitors = 4, .depth = 4, .window = 20, .restarts = 0.5},
     40},
    {"PrefixLongWindows",
     {.formulas = Formulas::prefix, .monitors = 2, .depth = 3, .window = 25},
     40},
};

INSTANTIATE_TEST_SUITE_P(Shapes, BooleanRandom, testing::ValuesIn(kCases),
                         [](const auto& shape) { return std::string(shape.param.name); });

}  // namespace
