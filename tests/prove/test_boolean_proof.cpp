// Tests `etlc prove` on classes of truth values: those of random specs are proved, and lines that
// are left out are found.
#include <gtest/gtest.h>

#include <cstdint>
#include <iterator>
#include <string>

#include "proving.hpp"
#include "random_spec.hpp"

namespace {

using namespace etlc;
using namespace etlc::tests;

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
        EXPECT_EQ(proof->together, kBooleanSteps);
        ASSERT_FALSE(proof->fault)
            << proof->fault->number << " of " << spec->plan.monitors[proof->fault->monitor].name
            << " after step " << proof->fault->step << "\n"
            << text;
    }
    EXPECT_GT(proved, n / 3);
}

/// A spec whose class has a line for everything that is left out below.
constexpr const char* kRestarts =
    "spec restarts;\ninput a, b : bool;\n"
    "restartable monitor one = F[2, 3] a;\nrepeating monitor other = G (a -> F[1, 2] b);\n"
    "monitor plain = F[1, 2] b;\n";

prove::Proof proof_without(const Compiled& spec, const std::string& line) {
    std::string header = header_of(spec.plan);
    const std::size_t at = header.find(line);
    EXPECT_NE(at, std::string::npos) << line;
    header.erase(at, line.size());
    auto proof = prove::prove(spec.plan, {header, "proved", kBooleanSteps});
    EXPECT_TRUE(proof) << proof.failure().message;
    return proof ? std::move(*proof) : prove::Proof();
}

TEST(ProveBoolean, RestartsAndResets) {
    const auto spec = compiled(kRestarts, check::Values::boolean);
    ASSERT_TRUE(spec);
    const prove::Proof unasked = proof_without(*spec, "    one_position_ = 0;\n");
    ASSERT_TRUE(unasked.fault);
    ASSERT_EQ(unasked.fault->requests.size(), 1U);
    EXPECT_EQ(unasked.fault->requests[0].first, 0U);
    EXPECT_EQ(unasked.fault->position, unasked.fault->requests[0].second);

    const prove::Proof left_over = proof_without(*spec, "    plain_ = etlmon::kNo;\n");
    ASSERT_TRUE(left_over.fault);
    EXPECT_EQ(left_over.fault->monitor, 2U);
}

TEST(ProveBoolean, RefusesWhatIsTooLarge) {
    const auto spec = compiled(
        "spec large;\ninput a, b : bool;\nmonitor often = G count(a && b, 30 steps) < 9;\n",
        check::Values::boolean);
    ASSERT_TRUE(spec);
    const auto proof = prove::prove(spec->plan, {header_of(spec->plan), "proved", 20, 10000});
    ASSERT_FALSE(proof);
    EXPECT_NE(proof.failure().message.find("; it is right for all inputs of up to "),
              std::string::npos)
        << proof.failure().message;
}

TEST(ProveBoolean, RefusesTextThatItDoesNotUnderstand) {
    const auto spec = compiled(kRestarts, check::Values::boolean);
    ASSERT_TRUE(spec);
    std::string header = header_of(spec->plan);
    const std::string line = "  bool missing = false;\n";
    header.replace(header.find(line), line.size(), line + "  while (position_ == 9) {}\n");
    const auto proof = prove::prove(spec->plan, {header, "proved", kBooleanSteps});
    ASSERT_FALSE(proof);
    EXPECT_NE(proof.failure().message.find("'while' in a step"), std::string::npos)
        << proof.failure().message;
}

}  // namespace
