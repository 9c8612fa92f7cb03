// Tests `etlc prove` on random specs: their classes are proved, and those of a faulty plan are not.
#include <gtest/gtest.h>

#include <cstdint>
#include <iterator>
#include <string>

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
    for (; n < 6 * effort(); ++n) {
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
    const auto right = prove::prove(spec->plan, {header, "proved", kLongest});
    ASSERT_TRUE(right && !right->fault && right->restarts);
    EXPECT_EQ(right->together, kLongest);

    const std::string asked = "one_position_ >= 2";
    ASSERT_NE(header.find(asked), std::string::npos);
    header.replace(header.find(asked), asked.size(),
                   "(one_position_ >= 2) != (one_position_ < position_ && other_position_ < "
                   "position_)");
    const auto wrong = prove::prove(spec->plan, {header, "proved", kLongest});
    ASSERT_TRUE(wrong && !wrong->fault);
    EXPECT_EQ(wrong->together, 0U);
}

}  // namespace
