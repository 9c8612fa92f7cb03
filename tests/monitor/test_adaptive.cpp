// Tests adaptive thresholds that labels move between the steps: compares the evaluator and the
// generated classes with the reference, and the bounds over continuations with the effects of other
// labels.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "adaptive.hpp"
#include "compare.hpp"
#include "generated_program.hpp"
#include "plan_runner.hpp"
#include "random_trace.hpp"

namespace {

using namespace etlc;
using namespace etlc::tests;
using check::Values;
using reference::evaluate;
using reference::Trace;

/// Makes the trace of that number: every other one has gaps.
TraceShape trace_shape(std::size_t n) {
    return {.steps = 6 + 4 * (n % 5),
            .missing = n % 2 == 0 ? 0 : 0.15,
            .invalid = n % 3 == 0 ? 0.05 : 0};
}

std::string words(const check::Model& model, const Trace& trace,
                  const reference::Thresholds& thresholds) {
    std::string text = std::string(model.file.text()) + to_csv(model, trace) + "thresholds\n";
    for (const auto& step : thresholds) text += fmt::format("{}\n", fmt::join(step, ", "));
    return text;
}

class AdaptivePlan : public testing::TestWithParam<Values> {};

TEST_P(AdaptivePlan, AgreesWithTheReference) {
    for (int n = 0; n < 150; ++n) {
        const AdaptiveSpec spec =
            random_adaptive_spec(70000 + n, kSmallShapes[n % std::size(kSmallShapes)]);
        ASSERT_TRUE(spec.model);
        PlanRunner runner(*spec.model, kRoomy, GetParam());
        if (!runner.refusal().empty()) continue;
        std::vector<double> thresholds =
            calibrated_thresholds(*spec.model);  // runs continue from the previous one
        for (int t = 0; t < 5; ++t) {
            const Trace trace = random_trace(*spec.model, 100 * n + t, trace_shape(t));
            const Labels labels = random_labels(*spec.model, trace, 9 * n + t);
            const auto at_steps = tracked(*spec.model, labels, thresholds);
            const auto mismatch =
                first_mismatch(*spec.model, evaluate(*spec.model, trace, GetParam(), at_steps),
                               runner.run(trace, &labels), {});
            ASSERT_FALSE(mismatch) << *mismatch << "\n" << words(*spec.model, trace, at_steps);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Values, AdaptivePlan, testing::Values(Values::robustness, Values::boolean),
                         [](const auto& values) {
                             return std::string(values.param == Values::boolean ? "Boolean"
                                                                                : "Robustness");
                         });

/// Whatever later steps and labels come, rho stays within the reported bounds.
TEST(AdaptiveReference, BoundsHoldForEveryContinuationAndAllLabels) {
    for (int n = 0; n < 60; ++n) {
        const AdaptiveSpec spec = random_adaptive_spec(71000 + n, kSmallShapes[n % 3]);
        ASSERT_TRUE(spec.model);
        const check::Model& model = *spec.model;
        const Trace trace = random_trace(model, n, {.steps = 10, .missing = n % 2 == 0 ? 0 : 0.15});
        const Labels labels = random_labels(model, trace, n);
        for (std::size_t i = 0; i < 10; i += 3) {
            std::vector<double> thresholds = calibrated_thresholds(model);
            const auto before =
                evaluate(model, trace, Values::robustness, tracked(model, labels, thresholds));
            Trace other(trace.begin(), trace.begin() + static_cast<std::ptrdiff_t>(i + 1));
            const Trace rest = random_trace(model, 77 * n + i, {.steps = 6, .extreme = 0.2});
            other.insert(other.end(), rest.begin(), rest.end());
            Labels others = random_labels(model, other, 1000 * n + i);
            std::copy_n(labels.begin(), i + 1, others.begin());
            thresholds = calibrated_thresholds(model);
            const auto after =
                evaluate(model, other, Values::robustness, tracked(model, others, thresholds));
            for (std::size_t later = i; later < other.size(); ++later)
                for (std::size_t m = 0; m < model.monitors.size(); ++m) {
                    const auto& said = before.verdicts[i][m];
                    ASSERT_LE(said.lower, after.verdicts[later][m].robustness)
                        << spec.text << i << ", " << later;
                    ASSERT_GE(said.upper, after.verdicts[later][m].robustness_high)
                        << spec.text << i << ", " << later;
                }
        }
    }
}

// ---- generated classes

/// Returns the first mismatch of one run; `thresholds` are those at its start, and are updated to
/// those at its end.
std::optional<std::string> mismatch(const check::Model& model, const Dependencies& dependencies,
                                    Values values, const Trace& trace, const Labels& labels,
                                    std::vector<double>& thresholds, Observed observed) {
    const auto at_steps = tracked(model, labels, thresholds);
    for (std::size_t step = 0; step < trace.size(); ++step)
        for (std::size_t p = 0; p < model.predicates.size(); ++p) {
            const auto& said = observed.telemetry[step][p].threshold;
            if (said && *said != at_steps[step][p])
                return fmt::format("step {}: threshold of {} is {}, expected {}\n{}", step,
                                   model.predicates[p].name, *said, at_steps[step][p],
                                   words(model, trace, at_steps));
        }
    observed.dependencies = dependencies;
    const auto found = first_mismatch(model, evaluate(model, trace, values, at_steps), observed,
                                      {0, values == Values::boolean});
    if (!found) return {};
    return *found + "\n" + words(model, trace, at_steps);
}

class AdaptiveGenerated : public testing::TestWithParam<Build> {};

TEST_P(AdaptiveGenerated, AgreesWithTheReference) {
    GeneratedProgram program(std::string("adaptive") + GetParam().name);
    std::vector<Values> values;
    std::vector<Request> requests;
    for (std::uint32_t n = 0; n < 2 * std::size(kSmallShapes); ++n) {
        const AdaptiveSpec spec =
            random_adaptive_spec(72000 + n, kSmallShapes[n % std::size(kSmallShapes)]);
        ASSERT_TRUE(spec.model);
        values.push_back(n < std::size(kSmallShapes) ? Values::robustness : Values::boolean);
        ASSERT_TRUE(program.add(*spec.model, values.back(), spec.thresholds));
        for (int t = 0; t < 8; ++t) {
            Request request{n,
                            random_trace(*spec.model, 10 * n + t, trace_shape(t)),
                            random_trace(*spec.model, 500 + 10 * n + t, trace_shape(t + 3)),
                            {},
                            {}};
            request.first_labels = random_labels(*spec.model, request.first, 2 * t);
            request.second_labels = random_labels(*spec.model, request.second, 2 * t + 1);
            requests.push_back(std::move(request));
        }
    }
    ASSERT_TRUE(program.compile(GetParam()));
    const auto result = program.run(requests);
    ASSERT_EQ(result.answers.size(), requests.size());
    EXPECT_EQ(result.allocations, 0U);
    for (std::size_t n = 0; n < requests.size(); ++n) {
        const Request& request = requests[n];
        const check::Model& model = program.model(request.spec);
        const Dependencies dependencies = PlanRunner(model, kRoomy).dependencies();
        const auto check = [&](const Trace& trace, const Labels& labels,
                               std::vector<double>& thresholds, int run) {
            const auto found = mismatch(model, dependencies, values[request.spec], trace, labels,
                                        thresholds, result.answers[n][run]);
            EXPECT_FALSE(found) << "run " << run << ": " << *found;
        };
        std::vector<double> first = calibrated_thresholds(model);
        std::vector<double> second = first;
        check(request.first, request.first_labels, first, 0);
        check(request.second, request.second_labels, second, 1);
        check(request.second, request.second_labels, first,
              2);  // after reset(), which keeps the thresholds
        if (HasFailure()) return;
    }
}

INSTANTIATE_TEST_SUITE_P(Builds, AdaptiveGenerated,
                         testing::Values(kGccSanitized, kClangFastMath, kGccFastMath),
                         [](const auto& build) { return build.param.name; });

}  // namespace
