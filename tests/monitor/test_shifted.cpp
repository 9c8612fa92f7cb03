// Tests monitors that are calibrated as a whole: `etlc run` and the generated classes give the
// verdicts of the reference minus the shift, in one float32 subtraction.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "artifacts/thresholds.hpp"
#include "check/guarantees/calibrated.hpp"
#include "check/guarantees/provenance.hpp"
#include "compare.hpp"
#include "generated_program.hpp"
#include "loading.hpp"
#include "plan_runner.hpp"
#include "random.hpp"
#include "random_spec.hpp"
#include "random_trace.hpp"

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
                                     random.word({"missed_alarm", "missed_success"})));
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
        entry.episodes = calibrate_to(
            shift, monitor.calibration->against == check::Against::missed_alarm, entry);
        entry.reads = check::reads(*uncalibrated, monitor);
        entry.against = check::word(monitor.calibration->against);
    }
    result.thresholds = thresholds::write(file);
    result.model = load_with_thresholds(text, result.thresholds);
    return result;
}

/// The shift is subtracted from rho and both bounds; infinities stay.
double less(double value, float shift) {
    return std::isinf(value) ? value : static_cast<double>(static_cast<float>(value) - shift);
}

void shift(const check::Monitor& monitor, Verdict& verdict) {
    if (!monitor.calibration || verdict.status == Status::undecided) return;
    for (double* number :
         {&verdict.lower, &verdict.robustness, &verdict.robustness_high, &verdict.upper})
        *number = less(*number, monitor.calibration->threshold.value);
    verdict.status = verdict.robustness >= 0       ? Status::satisfied
                     : verdict.robustness_high < 0 ? Status::violated
                                                   : Status::unknown;
    if (!monitor.sliding) verdict.final = verdict.lower >= 0 || verdict.upper < 0;
}

reference::Run expected_run(const check::Model& model, const Trace& trace) {
    reference::Run run = reference::evaluate(model, trace);
    for (auto* rows : {&run.verdicts, &run.finish})
        for (auto& row : *rows)
            for (std::size_t m = 0; m < row.size(); ++m) shift(model.monitors[m], row[m]);
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

INSTANTIATE_TEST_SUITE_P(Builds, ShiftedGenerated, testing::Values(kGccSanitized, kClangFastMath),
                         [](const auto& build) { return build.param.name; });

}  // namespace
