// Named cases, cases/NAME.etl with cases/NAME.csv: each once showed a fault. Expected values come from the reference
// when the test runs. A new case is two new files.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
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
namespace fs = std::filesystem;

std::vector<std::string> case_names() {
    std::vector<std::string> result;
    for (const auto& entry : fs::directory_iterator(fs::path(ETLC_SOURCE_DIR) / "tests/monitor/cases"))
        if (entry.path().extension() == ".etl") result.push_back(entry.path().stem().string());
    std::sort(result.begin(), result.end());
    return result;
}

class Case : public testing::TestWithParam<std::string> {};

TEST_P(Case, PlanAgreesWithTheReference) {
    const std::string stem = std::string(ETLC_SOURCE_DIR) + "/tests/monitor/cases/" + GetParam();
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
