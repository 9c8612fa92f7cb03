// Tests `etlc prove` on random specs: their classes are proved, and those of a faulty plan are not.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "emit/emit.hpp"
#include "library/version.hpp"
#include "loading.hpp"
#include "pipeline/compile.hpp"
#include "plan/evaluate/evaluator.hpp"
#include "prove/prove.hpp"
#include "random.hpp"
#include "random_spec.hpp"
#include "random_trace.hpp"

namespace {

using namespace etlc;
using namespace etlc::tests;

constexpr plan::Limits kAnySize{16U << 20U, 16U << 20U, 64U << 20U};

/// Factor on the number of random specs; ETLC_EFFORT=10 for 200 formulas and more.
int effort() {
    const char* text = std::getenv("ETLC_EFFORT");
    return text == nullptr ? 1 : std::max(1, std::atoi(text));
}

std::optional<pipeline::Compiled> compiled(const std::string& text, check::Values values) {
    auto model = load(text);
    if (!model) return std::nullopt;
    diag::Sink sink;
    return pipeline::compile(std::move(*model), {.limits = kAnySize, .values = values}, sink);
}

diag::Result<prove::Proof> proof_of(const plan::Plan& plan, std::uint32_t steps) {
    return prove::prove(
        plan, {emit::header(plan, {"proved", library::kVersion, "", "proved.targets.bin"}), "proved", steps});
}

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
        formulas += static_cast<int>(spec->plan.monitors.size());
    }
    RecordProperty("formulas", formulas);
    EXPECT_GT(formulas, 3 * n);
}

}  // namespace
