// Runs the named cases, each of which once revealed a bug. Expected values come from the reference;
// a new case is two new files. test_generated compiles them too.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "compare.hpp"
#include "loading.hpp"
#include "plan_runner.hpp"
#include "random_trace.hpp"
#include "reference/reference.hpp"

namespace {

using namespace etlc;
using namespace etlc::tests;

class Case : public testing::TestWithParam<std::string> {};

TEST_P(Case, PlanAgreesWithTheReference) {
    const std::string stem = case_path(GetParam());
    const auto model = load(read_text(stem + ".etl"), stem + ".etl");
    ASSERT_TRUE(model);
    const reference::Trace trace = read_csv(*model, stem + ".csv");
    ASSERT_FALSE(trace.empty());
    PlanRunner runner(*model);
    ASSERT_EQ(runner.refusal(), "");
    const auto mismatch =
        first_mismatch(*model, reference::evaluate(*model, trace), runner.run(trace), {});
    EXPECT_FALSE(mismatch) << *mismatch;
}

// docs/semantics.md: the reported bounds are those of the simplified formula, which are tighter
// than the definition's.
TEST(Constants, GoBeforeBoundsAreFound) {
    const std::string stem = case_path("constants");
    const auto model = load(read_text(stem + ".etl"), stem + ".etl");
    ASSERT_TRUE(model);
    const reference::Trace trace = read_csv(*model, stem + ".csv");
    const reference::Verdict as_written = reference::evaluate(*model, trace).verdicts[0][0];
    const reference::Verdict simplified = reference::evaluate(*model, trace).verdicts[0][1];
    PlanRunner runner(*model);
    const reference::Verdict reported = runner.run(trace).verdicts[0][0];
    EXPECT_EQ(as_written.lower, -5);
    EXPECT_EQ(simplified.lower, 3);
    EXPECT_EQ(reported.lower, simplified.lower);
    EXPECT_EQ(reported.upper, simplified.upper);
}

INSTANTIATE_TEST_SUITE_P(Named, Case, testing::ValuesIn(case_names()),
                         [](const auto& name) { return name.param; });

}  // namespace
