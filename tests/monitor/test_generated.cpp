// Compiles and steps the generated classes and compares them with the reference: g++ and clang++,
// with strict warnings, with sanitizers and with -ffast-math; two alternating instances, reset,
// many headers in one program, and no allocations.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "compare.hpp"
#include "exhaustive.hpp"
#include "generated_program.hpp"
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

/// Whose traces an exhaustive subject gets.
enum class Inputs : std::uint8_t { two, two_with_gaps, one };

struct Subject {
    std::string spec;
    bool exact = true;
    bool exhaustive = false;
    check::Values values = check::Values::robustness;
    Inputs inputs = Inputs::two;
};

/// Predicates over earlier numbers and earlier points.
std::vector<Subject> past_subjects() {
    std::vector<Subject> result;
    for (const bool points : {false, true}) {
        const std::string name = points ? "earlier_points" : "earlier_numbers";
        result.push_back({exhaustive_past_spec(name, {.points = points}), true, true,
                          check::Values::robustness, Inputs::one});
        result.push_back({exhaustive_past_spec(name + "_repeating",
                                               {.points = points, .kind = "repeating monitor"}),
                          true, true, check::Values::boolean, Inputs::one});
        result.push_back(
            {exhaustive_past_spec(name + "_of_two",
                                  {.points = points, .inputs = 2, .of_inputs = " hold 1"}),
             true, true, check::Values::robustness, Inputs::two_with_gaps});
    }
    return result;
}

std::vector<Subject> all_subjects() {
    std::vector<Subject> result{{exhaustive_spec(), true, true},
                                {exhaustive_sliding_spec(), true, true},
                                {exhaustive_spec("restarted", "restartable monitor"), true, true},
                                {exhaustive_chains_spec("chains", "monitor", 5), true, true}};
    const std::vector<SpecShape> shapes = {
        {.formulas = Formulas::unnested, .depth = 3},
        {.formulas = Formulas::unbounded_nesting, .depth = 3},
        {.formulas = Formulas::prefix, .monitors = 6, .depth = 3, .window = 3},
        {.formulas = Formulas::sliding, .depth = 4, .window = 3},
        {.formulas = Formulas::mixed, .depth = 3, .window = 3},
        {.formulas = Formulas::mixed,
         .monitors = 8,
         .depth = 3,
         .window = 4,
         .restarts = 0.9,
         .missing = 0.4},
        {.formulas = Formulas::chains, .monitors = 4, .depth = 30, .restarts = 0.3},
        {.formulas = Formulas::unnested, .depth = 2, .exact = false},
        {.formulas = Formulas::prefix, .monitors = 6, .depth = 2, .exact = false},
        {.formulas = Formulas::sliding, .depth = 3, .exact = false},
    };
    for (std::size_t n = 0; n < 2 * shapes.size(); ++n)
        result.push_back({random_spec(9000 + n, shapes[n / 2]), shapes[n / 2].exact});
    for (const std::string& name : case_names())
        result.push_back({read_text(case_path(name) + ".etl")});
    // Truth values need exact comparisons: numbers on a grid.
    result.push_back({exhaustive_spec("boolean_prefix"), true, true, check::Values::boolean});
    result.push_back(
        {exhaustive_sliding_spec("boolean_sliding"), true, true, check::Values::boolean});
    result.push_back({exhaustive_chains_spec("boolean_chains", "repeating monitor", 5), true, true,
                      check::Values::boolean});
    for (const Subject& subject : past_subjects()) result.push_back(subject);
    for (std::size_t n = 0; n < shapes.size(); ++n)
        if (shapes[n].exact)
            result.push_back(
                {random_spec(9100 + n, shapes[n]), true, false, check::Values::boolean});
    return result;
}

const std::vector<Build> kBuilds = {kGccSanitized, kClangSanitized, kClangFastMath, kGccFastMath,
                                    kAarch64};

/// Each build has half of the subjects. Each subject has both compilers: one with sanitizers, the
/// other with -ffast-math.
std::vector<Subject> subjects(std::size_t build) {
    const std::vector<Subject> all = all_subjects();
    std::vector<Subject> result;
    for (std::size_t n = 0; n < all.size(); ++n)
        if ((n + (build < 4 ? build : n / 2)) % 2 == 0) result.push_back(all[n]);
    return result;
}

/// Pairs of traces for one spec.
std::vector<Request> requests_for(const check::Model& model, std::uint32_t spec,
                                  const Subject& subject) {
    std::vector<Request> result;
    if (subject.exhaustive) {
        for (const bool gaps : {false, true}) {
            if (!gaps && subject.inputs == Inputs::two_with_gaps) continue;
            const AllTraces traces = subject.inputs == Inputs::one
                                         ? AllTraces(gaps ? 5 : 8, gaps, 1)
                                         : AllTraces(gaps ? 3 : 5, gaps);
            for (std::size_t n = 0; n < traces.size(); n += 2)
                result.push_back({spec, traces[n], traces[std::min(n + 1, traces.size() - 1)]});
        }
        return result;
    }
    for (std::uint64_t n = 0; n < 12; ++n) {
        TraceShape shape{.steps = 4 + 3 * n, .grid = subject.exact};
        if (n % 3 > 0) shape.missing = 0.15;
        if (n % 3 > 1) shape.invalid = 0.1;
        Request request{spec, random_trace(model, 200 + n, shape), {}};
        shape.steps = 30 - 2 * n;
        request.second = random_trace(model, 300 + n, shape);
        result.push_back(std::move(request));
    }
    return result;
}

/// The constant parts of all requests to one spec.
struct Expectation {
    const check::Model& model;
    Dependencies dependencies;  ///< of the plan that the class was made from
    double rounding;
    check::Values values;

    std::optional<std::string> mismatch(const reference::Trace& trace, Observed observed,
                                        const char* run) const {
        observed.dependencies = dependencies;
        const Comparison comparison{rounding, values == check::Values::boolean};
        const auto found = first_mismatch(model, expected_run(model, trace, observed, values),
                                          observed, comparison);
        if (!found) return {};
        return fmt::format("{}: {}\n{}\n{}", run, *found, model.file.text(), to_csv(model, trace));
    }

    std::optional<std::string> mismatch(const Request& request, const Answer& answer) const {
        if (auto found = mismatch(request.first, answer[0], "first instance")) return found;
        if (auto found = mismatch(request.second, answer[1], "second instance, in turns"))
            return found;
        return mismatch(request.second, answer[2], "first instance after reset");
    }
};

class Generated : public testing::TestWithParam<std::size_t> {};

TEST_P(Generated, AgreesWithTheReference) {
    const Build& build = kBuilds[GetParam()];
    const std::vector<Subject> all = subjects(GetParam());
    GeneratedProgram program(build.name);
    std::vector<Request> requests;
    for (const Subject& subject : all) {
        const auto model = load(subject.spec);
        ASSERT_TRUE(model);
        ASSERT_TRUE(program.add(*model, subject.values));
        const auto more =
            requests_for(*model, static_cast<std::uint32_t>(program.size() - 1), subject);
        requests.insert(requests.end(), more.begin(), more.end());
    }
    ASSERT_TRUE(program.compile(build));
    const auto result = program.run(requests);
    ASSERT_EQ(result.answers.size(), requests.size());
    std::vector<Expectation> expected;
    for (std::size_t n = 0; n < all.size(); ++n)
        expected.push_back({program.model(n), PlanRunner(program.model(n), kRoomy).dependencies(),
                            all[n].exact ? 0 : kRounding, all[n].values});
    std::vector<bool> failed(all.size());  // one mismatch is reported per spec
    for (std::size_t n = 0; n < requests.size(); ++n) {
        const std::uint32_t spec = requests[n].spec;
        if (failed[spec]) continue;
        const auto mismatch = expected[spec].mismatch(requests[n], result.answers[n]);
        EXPECT_FALSE(mismatch) << *mismatch;
        failed[spec] = mismatch.has_value();
    }
    EXPECT_EQ(result.allocations, 0U);

    // The counting works: it detects every way in which a program allocates on purpose.
    const auto control = program.run({requests[0]}, "misbehave");
    const std::uint64_t watched = requests[0].first.size() + 2 * requests[0].second.size() + 3;
    EXPECT_GE(control.allocations, watched * (build.counts_malloc ? 3 : 1));
}

// Compilers take minutes for one function of 1,000 monitors.
TEST(LargeClasses, JudgeInParts) {
    std::string text = "spec large;\ninput calm : bool;\nlet still = H[0, 3 steps] calm;\n";
    for (int i = 0; i < 100; ++i)
        text += fmt::format(
            "input a{0}, b{0} : bool;\n"
            "{1}monitor m{0} = G (a{0} && still -> F[0, 20 steps] b{0});\n",
            i, i % 3 == 1 ? "repeating " : "");
    GeneratedProgram program("LargeClass");
    const auto model = load(text);
    ASSERT_TRUE(model);
    ASSERT_TRUE(program.add(*model));
    const std::string header = read_text((program.folder() / "large.hpp").string());
    EXPECT_NE(header.find("judge_8(now, shared, verdicts);"), std::string::npos);
    EXPECT_NE(header.find("shared."), std::string::npos);
    ASSERT_TRUE(program.compile(kGccFastMath));
    std::vector<Request> requests;
    for (std::uint64_t n = 0; n < 2; ++n) {
        const TraceShape shape{.steps = 40, .missing = 0.05 * static_cast<double>(n)};
        requests.push_back(
            {0, random_trace(*model, 20 + n, shape), random_trace(*model, 30 + n, shape)});
    }
    const auto result = program.run(requests);
    ASSERT_EQ(result.answers.size(), requests.size());
    const Expectation expected{program.model(0),
                               PlanRunner(program.model(0), kRoomy).dependencies(), 0,
                               check::Values::robustness};
    for (std::size_t n = 0; n < requests.size(); ++n) {
        const auto mismatch = expected.mismatch(requests[n], result.answers[n]);
        EXPECT_FALSE(mismatch) << *mismatch;
    }
}

INSTANTIATE_TEST_SUITE_P(Builds, Generated, testing::Range(std::size_t{0}, kBuilds.size()),
                         [](const auto& build) { return kBuilds[build.param].name; });

}  // namespace
