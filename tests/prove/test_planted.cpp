// Tests `etlc prove` on classes of faulty plans: an interval off by one, a fold of the wrong kind.
// A fault that changes a verdict on some random trace is found; the input that shows it does.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "planting.hpp"

namespace {

using namespace etlc;
using namespace etlc::tests;

/// Proves classes of plans with a fault each; returns how many were found.
int faults_found(check::Values values, int count, std::uint32_t steps) {
    Random random(3);
    int found = 0;
    for (int n = 0; n < count; ++n) {
        const std::string text = plain_spec(n);
        const auto spec = compiled(text, values);
        if (!spec) continue;
        const std::vector<Fault> faults = faults_of(spec->plan);
        if (faults.empty()) continue;
        plan::Plan wrong = spec->plan;
        faults[random.between(0, static_cast<int>(faults.size()) - 1)](wrong);
        const auto proof = proof_of(wrong, steps);
        EXPECT_TRUE(proof) << proof.failure().message << "\n" << text;
        if (!proof) continue;
        if (proof->fault) {
            ++found;
            EXPECT_TRUE(is_shown(spec->plan, wrong, *proof))
                << proof->fault->number << " after step " << proof->fault->step << "\n"
                << text;
        } else {
            EXPECT_FALSE(differ(spec->plan, wrong, 200, steps)) << n << "\n" << text;
        }
    }
    return found;
}

TEST(Prove, FaultsOfThePlanAreFound) {
    EXPECT_GE(faults_found(check::Values::robustness, 8 * effort(), 16), 2);
}
TEST(ProveBoolean, FaultsOfThePlanAreFound) {
    EXPECT_GE(faults_found(check::Values::boolean, effort(), 8), 1);
}

}  // namespace
