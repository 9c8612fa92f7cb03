// Tests monitors that are calibrated as a whole, and predicates and monitors with two thresholds:
// `etlc run` and the generated classes give the verdicts of the reference minus the shifts, in one
// float32 subtraction each.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "artifacts/thresholds.hpp"
#include "check/guarantees/calibrated.hpp"
#include "check/guarantees/conformal.hpp"
#include "check/guarantees/provenance.hpp"
#include "compare.hpp"
#include "generated_program.hpp"
#include "loading.hpp"
#include "plan_runner.hpp"
#include "random.hpp"
#include "random_spec.hpp"
#include "random_trace.hpp"
#include "reference/normal_form.hpp"
#include "restart_schedule.hpp"

namespace {

using namespace etlc;
using namespace etlc::tests;
using reference::Status;
using reference::Trace;
using reference::Verdict;

struct ShiftedSpec {
    std::string thresholds;
    std::optional<check::Model> model;
};

/// Shifts most monitors of random_spec: by little, by much, by an amount that rounds, and by
/// nothing.
ShiftedSpec random_shifted_spec(std::uint64_t seed, const SpecShape& shape) {
    Random random(seed ^ 0x51f7ULL);
    std::string text;
    std::istringstream lines(random_spec(seed, shape));
    for (std::string line; std::getline(lines, line);) {
        const bool shifted = line.find("monitor ") < 9 && random.chance(0.8);
        if (shifted)
            line.replace(line.size() - 1, 1,
                         fmt::format(" calibrated(conformal, alpha = 0.1, against = {});",
                                     random.word({"missed_alarm", "missed_success", "both"})));
        text += line + "\n";
    }
    ShiftedSpec result;
    const auto uncalibrated = load_uncalibrated(text);
    if (!uncalibrated) return result;
    thresholds::File file;
    file.spec = uncalibrated->name;
    for (const check::Monitor& monitor : uncalibrated->monitors) {
        if (!monitor.calibration) continue;
        thresholds::Entry& entry = file.monitors[monitor.name];
        entry.method = "conformal";
        entry.alpha = "0.1";
        const float shift = random.chance(0.2)   ? 0.0F
                            : random.chance(0.3) ? static_cast<float>(random.grid(-3, 3, 0.25))
                                                 : static_cast<float>(4 * random.uniform() - 2);
        entry.against = check::word(monitor.calibration->against);
        const bool above = check::is_above(monitor.calibration->against, false);
        std::optional<float> inner;
        if (entry.against == "both")
            inner = random.chance(0.1) ? check::infinite(!above)
                                       : shift + static_cast<float>(random.grid(-1, 3, 0.5));
        const bool has_outer = !inner || std::isinf(*inner) || random.chance(0.9);
        entry.episodes =
            calibrate_to(has_outer ? shift : check::infinite(above), above, entry, inner);
        entry.reads = check::reads(*uncalibrated, monitor);
    }
    result.thresholds = thresholds::write(file);
    result.model = load_with_thresholds(text, result.thresholds);
    return result;
}

/// The shift is subtracted from rho and both bounds; infinities stay, unless the shift is infinite.
double less(double value, float shift) {
    if (std::isinf(shift)) return -static_cast<double>(shift);
    return std::isinf(value) ? value : static_cast<double>(static_cast<float>(value) - shift);
}

void shift(const check::Monitor& monitor, Verdict& verdict) {
    if (!monitor.calibration || verdict.status == Status::undecided) return;
    for (double* number : {&verdict.lower, &verdict.robustness})
        *number = less(*number, monitor.calibration->low());
    for (double* number : {&verdict.robustness_high, &verdict.upper})
        *number = less(*number, monitor.calibration->value);
    verdict.status = verdict.robustness >= 0       ? Status::satisfied
                     : verdict.robustness_high < 0 ? Status::violated
                                                   : Status::unknown;
    if (!monitor.sliding) verdict.final = verdict.lower >= 0 || verdict.upper < 0;
}

reference::Run expected_run(const check::Model& model, const Trace& trace) {
    reference::Run run = reference::evaluate(model, trace);
    for (auto* rows : {&run.verdicts, &run.finish})
        for (std::size_t i = 0; i < rows->size(); ++i)
            for (std::size_t m = 0; m < (*rows)[i].size(); ++m)
                shift(model.monitors[m], (*rows)[i][m]);
    return run;
}

TraceShape trace_shape(std::size_t n) {
    return {.steps = 5 + 4 * (n % 6),
            .missing = n % 2 == 0 ? 0 : 0.15,
            .invalid = n % 3 == 0 ? 0.05 : 0};
}

TEST(ShiftedPlan, AgreesWithTheReferenceLessTheShift) {
    int shifted = 0;
    for (int n = 0; n < 150; ++n) {
        const ShiftedSpec spec =
            random_shifted_spec(80000 + n, kSmallShapes[n % std::size(kSmallShapes)]);
        ASSERT_TRUE(spec.model);
        PlanRunner runner(*spec.model, kRoomy);
        if (!runner.refusal().empty()) continue;
        for (const check::Monitor& monitor : spec.model->monitors)
            shifted += monitor.calibration ? 1 : 0;
        for (int t = 0; t < 5; ++t) {
            const Trace trace = random_trace(*spec.model, 100 * n + t, trace_shape(t));
            const auto mismatch = first_mismatch(*spec.model, expected_run(*spec.model, trace),
                                                 runner.run(trace), {});
            ASSERT_FALSE(mismatch) << *mismatch << "\n"
                                   << spec.model->file.text() << to_csv(*spec.model, trace);
        }
    }
    EXPECT_GT(shifted, 300);
}

class ShiftedGenerated : public testing::TestWithParam<Build> {};

TEST_P(ShiftedGenerated, AgreesWithTheReferenceAndWithRun) {
    GeneratedProgram program(std::string("shifted") + GetParam().name);
    std::vector<Request> requests;
    for (std::uint32_t n = 0; n < 2 * std::size(kSmallShapes); ++n) {
        const ShiftedSpec spec =
            random_shifted_spec(81000 + n, kSmallShapes[n % std::size(kSmallShapes)]);
        ASSERT_TRUE(spec.model);
        ASSERT_TRUE(program.add(*spec.model, check::Values::robustness, spec.thresholds));
        for (int t = 0; t < 8; ++t)
            requests.push_back({n,
                                random_trace(*spec.model, 10 * n + t, trace_shape(t)),
                                random_trace(*spec.model, 500 + 10 * n + t, trace_shape(t + 3)),
                                {},
                                {}});
    }
    ASSERT_TRUE(program.compile(GetParam()));
    const auto result = program.run(requests);
    ASSERT_EQ(result.answers.size(), requests.size());
    EXPECT_EQ(result.allocations, 0U);
    for (std::size_t n = 0; n < requests.size(); ++n) {
        const check::Model& model = program.model(requests[n].spec);
        PlanRunner runner(model, kRoomy);
        for (int run = 0; run < 3; ++run) {
            const Trace& trace = run == 0 ? requests[n].first : requests[n].second;
            Observed observed = result.answers[n][run];
            observed.dependencies = runner.dependencies();
            const auto mismatch = first_mismatch(model, expected_run(model, trace), observed, {});
            ASSERT_FALSE(mismatch) << *mismatch << "\n"
                                   << model.file.text() << to_csv(model, trace);
            const Observed evaluated = runner.run(trace);
            for (std::size_t step = 0; step < trace.size(); ++step)
                for (std::size_t m = 0; m < model.monitors.size(); ++m) {
                    const Verdict& compiled = observed.verdicts[step][m];
                    const Verdict& executed = evaluated.verdicts[step][m];
                    ASSERT_EQ(compiled.status, executed.status);
                    ASSERT_EQ(compiled.final, executed.final);
                    ASSERT_EQ(compiled.lower, executed.lower);
                    ASSERT_EQ(compiled.robustness, executed.robustness);
                    ASSERT_EQ(compiled.upper, executed.upper);
                }
        }
    }
}

// ---- predicates with two thresholds
// --------------------------------------------------------------

using Formulas = SpecShape::Formulas;

const SpecShape kTwoShapes[] = {
    {.formulas = Formulas::unnested, .depth = 3, .missing = 0.3},
    {.formulas = Formulas::prefix, .monitors = 4, .depth = 3, .window = 3},
    {.formulas = Formulas::sliding, .depth = 4, .window = 3},
    {.formulas = Formulas::mixed, .monitors = 6, .depth = 3, .window = 4, .restarts = 0.8},
    {.formulas = Formulas::chains, .monitors = 3, .depth = 20, .restarts = 0.5, .missing = 0.3},
};

/// How often something occurred that the test is about.
struct Occurred {
    int two = 0;            ///< predicates with two thresholds
    int infinite = 0;       ///< of these with an infinite one
    int unknown_final = 0;  ///< verdicts that are unknown for good, of repeating monitors

    void add(const check::Model& model) {
        for (const check::Predicate& predicate : model.predicates) {
            two += predicate.threshold.inner ? 1 : 0;
            infinite += predicate.threshold.inner && (std::isinf(*predicate.threshold.inner) ||
                                                      std::isinf(predicate.threshold.value))
                            ? 1
                            : 0;
        }
    }
    void add(const check::Model& model, const Observed& observed) {
        for (const auto& row : observed.verdicts)
            for (std::size_t m = 0; m < row.size(); ++m)
                unknown_final +=
                    !model.monitors[m].sliding && row[m].final && row[m].status == Status::unknown
                        ? 1
                        : 0;
    }
};

class TwoThresholds : public testing::TestWithParam<check::Values> {};

TEST_P(TwoThresholds, ThePlanAgreesWithTheReference) {
    Occurred occurred;
    for (int n = 0; n < 200; ++n) {
        const CalibratedSpec spec = with_two_thresholds(
            random_spec(82000 + n, kTwoShapes[n % std::size(kTwoShapes)]), 82000 + n);
        ASSERT_TRUE(spec.model);
        PlanRunner runner(*spec.model, kRoomy, GetParam());
        if (!runner.refusal().empty()) continue;
        occurred.add(*spec.model);
        for (int t = 0; t < 5; ++t) {
            const Trace trace = random_trace(*spec.model, 100 * n + t, trace_shape(t));
            const Observed observed = runner.run(trace);
            occurred.add(*spec.model, observed);
            const auto mismatch = first_mismatch(
                *spec.model, expected_run(*spec.model, trace, observed, GetParam()), observed, {});
            ASSERT_FALSE(mismatch) << *mismatch << "\n"
                                   << spec.thresholds << spec.text << to_csv(*spec.model, trace);
        }
    }
    EXPECT_GT(occurred.two, 300);
    EXPECT_GT(occurred.infinite, 30);
    EXPECT_GT(occurred.unknown_final, 100);
}

INSTANTIATE_TEST_SUITE_P(Values, TwoThresholds,
                         testing::Values(check::Values::robustness, check::Values::boolean),
                         [](const auto& values) {
                             return values.param == check::Values::boolean ? "Boolean"
                                                                           : "Robustness";
                         });

class TwoThresholdsGenerated : public testing::TestWithParam<Build> {};

TEST_P(TwoThresholdsGenerated, AgreeWithTheReference) {
    GeneratedProgram program(std::string("two_thresholds") + GetParam().name);
    std::vector<Request> requests;
    for (std::uint32_t n = 0; n < 4 * std::size(kTwoShapes); ++n) {
        const CalibratedSpec spec = with_two_thresholds(
            random_spec(83000 + n, kTwoShapes[n % std::size(kTwoShapes)]), 83000 + n);
        ASSERT_TRUE(spec.model);
        const auto values = n % 4 == 3 ? check::Values::boolean : check::Values::robustness;
        ASSERT_TRUE(program.add(*spec.model, values, spec.thresholds));
        for (int t = 0; t < 6; ++t)
            requests.push_back({n,
                                random_trace(*spec.model, 10 * n + t, trace_shape(t)),
                                random_trace(*spec.model, 500 + 10 * n + t, trace_shape(t + 3)),
                                {},
                                {}});
    }
    ASSERT_TRUE(program.compile(GetParam()));
    const auto result = program.run(requests);
    ASSERT_EQ(result.answers.size(), requests.size());
    EXPECT_EQ(result.allocations, 0U);
    for (std::size_t n = 0; n < requests.size(); ++n) {
        const check::Model& model = program.model(requests[n].spec);
        const auto values =
            requests[n].spec % 4 == 3 ? check::Values::boolean : check::Values::robustness;
        PlanRunner runner(model, kRoomy, values);
        for (int run = 0; run < 3; ++run) {
            const Trace& trace = run == 0 ? requests[n].first : requests[n].second;
            Observed observed = result.answers[n][run];
            observed.dependencies = runner.dependencies();
            const auto mismatch =
                first_mismatch(model, expected_run(model, trace, observed, values), observed,
                               {.on_demand = values == check::Values::boolean});
            ASSERT_FALSE(mismatch) << *mismatch << "\n"
                                   << model.file.text() << to_csv(model, trace);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Builds, TwoThresholdsGenerated,
                         testing::Values(kGccSanitized, kClangFastMath),
                         [](const auto& build) { return build.param.name; });

INSTANTIATE_TEST_SUITE_P(Builds, ShiftedGenerated, testing::Values(kGccSanitized, kClangFastMath),
                         [](const auto& build) { return build.param.name; });

}  // namespace
