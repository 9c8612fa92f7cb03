// Tests `etlc prove` on random specs: their classes are proved, those of truth values too; that a
// proof holds for all lengths is said of right classes.
#include <gtest/gtest.h>

#include <cstdint>
#include <iterator>
#include <string>
#include <utility>

#include "prove/coverage.hpp"
#include "prove/prove.hpp"
#include "proving.hpp"
#include "random_spec.hpp"

namespace {

using namespace etlc;
using namespace etlc::tests;

const SpecShape kShapes[] = {
    {.formulas = SpecShape::Formulas::mixed, .depth = 3, .window = 4, .missing = 0.3},
    {.formulas = SpecShape::Formulas::prefix, .monitors = 5, .depth = 3, .window = 6},
    {.formulas = SpecShape::Formulas::mixed, .monitors = 5, .depth = 3, .window = 4, .restarts = 1},
    {.formulas = SpecShape::Formulas::sliding, .depth = 3, .window = 8},
    {.formulas = SpecShape::Formulas::unbounded_nesting, .depth = 3},
    {.formulas = SpecShape::Formulas::chains, .monitors = 4, .depth = 6, .restarts = 0.5},
};
constexpr std::uint32_t kLongest = 20;

TEST(Prove, RandomClassesAreRight) {
    int formulas = 0, n = 0;
    for (; n < 4 * effort(); ++n) {
        const SpecShape& shape = kShapes[n % std::size(kShapes)];
        const auto values = n % 3 == 2 ? check::Values::sourced : check::Values::robustness;
        const std::string text = random_spec(7000 + n, shape);
        const auto spec = compiled(text, values);
        if (!spec) continue;
        const auto proof = proof_of(spec->plan, kLongest);
        ASSERT_TRUE(proof) << proof.failure().message << "\n" << text;
        ASSERT_FALSE(proof->fault)
            << proof->fault->number << " of " << spec->plan.monitors[proof->fault->monitor].name
            << " after step " << proof->fault->step << "\n"
            << text;
        EXPECT_EQ(proof->why_not_longer.find("one step at a time"), std::string::npos) << text;
        formulas += static_cast<int>(spec->plan.monitors.size());
    }
    RecordProperty("formulas", formulas);
    EXPECT_GT(formulas, 3 * n);
}

/// A class whose monitors disturb each other only if both are restarted.
TEST(Prove, RestartsOfSeveralMonitors) {
    const auto spec = compiled(
        "spec restarts;\ninput a, b : bool;\n"
        "restartable monitor one = F[2, 3] a;\nrestartable monitor other = G (a -> F[1, 2] b);\n"
        "monitor plain = F[1, 2] b;\n",
        check::Values::robustness);
    ASSERT_TRUE(spec);
    std::string header = header_of(spec->plan);
    const std::string asked = "one_position_ >= 2";
    ASSERT_NE(header.find(asked), std::string::npos);
    header.replace(header.find(asked), asked.size(),
                   "(one_position_ >= 2) != (one_position_ < position_ && other_position_ < "
                   "position_)");
    const auto wrong = prove::prove(spec->plan, {header, "proved", kLongest});
    ASSERT_TRUE(wrong && wrong->fault);
    EXPECT_EQ(wrong->fault->restarts.size(), 2U);
}

/// Between two thresholds a predicate is unknown; a repeating monitor goes on where its formula
/// looks no further ahead, even if its verdict is unknown, which counts as nothing.
TEST(Prove, TwoThresholds) {
    for (const auto values : {check::Values::robustness, check::Values::boolean}) {
        auto model = load(
            "spec between;\ninput x, y : f32;\n"
            "predicate near = x <= 1;\npredicate far = y > 1 missing true;\n"
            "repeating monitor cycle = F[0, 3] near;\n"
            "monitor either = G[0, 2] near iff F[0, 1] far;\n");
        ASSERT_TRUE(model);
        model->predicates[0].threshold.inner = 0.5F;
        model->predicates[1].threshold.inner = 2.0F;
        const auto spec = compiled(std::move(*model), values);
        ASSERT_TRUE(spec);
        const auto proof = proof_of(spec->plan, 8);
        ASSERT_TRUE(proof) << proof.failure().message;
        EXPECT_FALSE(proof->fault) << proof->fault->number << " " << proof->fault->step;
        for (const auto& [right, wrong] :
             {std::pair<std::string, std::string>("cycle_position_ >= 3", "cycle_position_ >= 2"),
              {"cycle.alarm() &&", "cycle.final() &&"}}) {
            std::string header = header_of(spec->plan);
            const std::size_t at = header.find(right);
            ASSERT_NE(at, std::string::npos) << header;
            header.replace(at, right.size(), wrong);
            const auto found = prove::prove(spec->plan, {header, "proved", 8});
            EXPECT_TRUE(!found || found->fault) << wrong;
        }
    }
}

// ---- classes of truth values

const SpecShape kBooleanShapes[] = {
    {.formulas = SpecShape::Formulas::prefix,
     .monitors = 5,
     .depth = 2,
     .window = 3,
     .restarts = 1},
    {.formulas = SpecShape::Formulas::mixed, .monitors = 5, .depth = 3, .restarts = 1},
    {.formulas = SpecShape::Formulas::sliding, .depth = 2, .window = 3, .missing = 0.3},
    {.formulas = SpecShape::Formulas::prefix, .monitors = 5, .depth = 3, .window = 3},
    {.formulas = SpecShape::Formulas::chains, .monitors = 4, .depth = 5, .restarts = 0.5},
    {.formulas = SpecShape::Formulas::unbounded_nesting, .depth = 3},
};
constexpr std::uint32_t kBooleanSteps = 7;

TEST(ProveBoolean, RandomClassesAreRight) {
    int proved = 0, n = 0;
    for (; n < effort(); ++n) {
        const std::string text =
            random_spec(8000 + n, kBooleanShapes[n % std::size(kBooleanShapes)]);
        const auto spec = compiled(text, check::Values::boolean);
        if (!spec) continue;
        const auto proof =
            prove::prove(spec->plan, {header_of(spec->plan), "proved", kBooleanSteps, 100000});
        if (!proof) {
            EXPECT_NE(proof.failure().message.find("too many states"), std::string::npos)
                << proof.failure().message << "\n"
                << text;
            continue;
        }
        ++proved;
        ASSERT_FALSE(proof->fault)
            << proof->fault->number << " of " << spec->plan.monitors[proof->fault->monitor].name
            << " after step " << proof->fault->step << "\n"
            << text;
    }
    EXPECT_GT(proved, n / 3);
}

/// A monitor whose verdict is not final is open or not: each such answer is a way through a step.
TEST(ProveBoolean, RefusesWhatIsTooLarge) {
    const auto spec = compiled(
        "spec large;\ninput a, b : bool;\nmonitor often = G count(a && b, 30 steps) < 9;\n",
        check::Values::boolean);
    ASSERT_TRUE(spec);
    const auto proof = prove::prove(spec->plan, {header_of(spec->plan), "proved", 20, 10});
    ASSERT_FALSE(proof);
    EXPECT_NE(proof.failure().message.find("too many states and ways"), std::string::npos)
        << proof.failure().message;
}

// ---- all lengths

TEST(Lengths, RightClassesAreProvedForAll) {
    const std::string spec =
        "spec all;\n"
        "input x, y : f32 in [-1, 1];\n"
        "input on : bool;\n"
        "predicate p = x > 0.25;\n"
        "predicate q = y <= 0.25;\n";
    for (const char* const monitors :
         {"monitor m = G (p -> F[0, 3] (q && F[0, 2] on));\nmonitor n = p U[2, 5] q;\n",
          "sliding monitor m = F[2, 6] p;\nsliding monitor n = p S[1, 4] q || O[2, 3] G[0, 2] "
          "on;\n",
          "monitor m = F (fraction(p, 4 steps) > 0.5 && on);\n"
          "monitor n = G fraction(q, 3 steps) < 0.6;\n",
          "monitor m = F[1, 3] (p S q) && G count(p, 6 steps) < 3;\nmonitor n = on U[3, inf] "
          "p;\n"}) {
        const auto all = compiled(spec + monitors, check::Values::robustness);
        ASSERT_TRUE(all) << monitors;
        const auto proof = proof_of(all->plan, 0);
        ASSERT_TRUE(proof) << proof.failure().message;
        EXPECT_FALSE(proof->fault);
        ASSERT_TRUE(proof->repeats) << monitors << proof->why_not_longer;
        EXPECT_LT(proof->repeats->first, proof->repeats->second);
    }
}

/// The machine once gave verdicts about runs with restarts, which it had not taken.
TEST(Lengths, RestartsComeAfterTheMachine) {
    const auto spec = compiled(
        "spec restarts;\ninput a : bool;\nrestartable monitor one = F[2, 3] a;\n"
        "sliding monitor other = F[0, 9] a;\n",
        check::Values::robustness);
    ASSERT_TRUE(spec);
    const auto proof = proof_of(spec->plan, 16);
    ASSERT_TRUE(proof && !proof->fault);
    EXPECT_FALSE(proof->repeats);
}

TEST(Coverage, AddsInstancesOfTemplates) {
    const std::string json = R"({"files": [
      {"file": "runtime/value.hpp", "lines": [{"line_number": 3, "count": 9, "branches": []}]},
      {"file": "header/class.hpp", "lines": [
        {"line_number": 7, "count": 2, "branches": [{"count": 2, "throw": false},
          {"count": 0, "throw": false}, {"count": 0, "throw": true}]},
        {"line_number": 5, "count": 0, "branches": []},
        {"line_number": 7, "count": 3, "branches": [{"count": 0, "throw": false},
          {"count": 3, "throw": false}]}]}]})";
    const auto lines = prove::coverage_of(json, "class.hpp");
    ASSERT_TRUE(lines);
    ASSERT_EQ(lines->size(), 2U);
    EXPECT_EQ(lines->front().number, 5U);
    EXPECT_EQ(lines->front().count, 0U);
    EXPECT_EQ(lines->back().number, 7U);
    EXPECT_EQ(lines->back().count, 5U);
    EXPECT_EQ(lines->back().ways, (std::vector<std::uint64_t>{2, 3}));
    EXPECT_FALSE(prove::coverage_of("gcov: not found", "class.hpp"));
    EXPECT_FALSE(prove::coverage_of(json, "other.hpp"));
}

}  // namespace
