// The named cases, each of which once showed a fault. Expected values come from the reference when the test runs; a new
// case is two new files. test_generated compiles them too.
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
    const auto mismatch = first_mismatch(*model, reference::evaluate(*model, trace), runner.run(trace), {});
    EXPECT_FALSE(mismatch) << *mismatch;
}

INSTANTIATE_TEST_SUITE_P(Named, Case, testing::ValuesIn(case_names()), [](const auto& name) { return name.param; });

}  // namespace
