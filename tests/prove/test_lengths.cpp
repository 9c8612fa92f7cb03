// Tests that a proof holds for all lengths: it is said of right classes, and never of one whose
// fault comes late.
#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "prove/prove.hpp"
#include "proving.hpp"

namespace {

using namespace etlc;
using namespace etlc::tests;

const char* const kSoon =
    "spec soon;\n"
    "input x : f32 in [-1, 1];\n"
    "monitor answer = G (x < 0 -> F[0, 3] x > 0.5);\n";

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

/// Changes of the class of kSoon whose verdicts are right for many steps.
struct Late {
    const char* name;
    std::string old, now;
};

const std::string kEnd = "  Verdicts verdicts;\n";
const std::string kForget = "answer_settled_ = etlmon::kTrue;\n";
const std::string kMember = "  uint32_t position_{};";
const std::string kAsks = "position_ >= 3";

const Late kLate[] = {
    {"right", kEnd, kEnd},
    {"a bound", kAsks, "position_ >= 3 && position_ < 300"},
    {"one step", kAsks, "position_ >= 3 && position_ != 200"},
    {"every 128 steps", kAsks, "position_ >= 3 && position_ % 128 != 127"},
    {"16 bits", kAsks, "static_cast<uint16_t>(position_) >= 3"},
    {"a local", kEnd, "  const uint32_t at = position_;\n  if (at == 150) " + kForget + kEnd},
    {"a counter that begins again", kEnd, "  if (position_ == 90) position_ = 0;\n" + kEnd},
    {"a static counter", kEnd,
     "  static uint32_t calls = 0;\n  if (++calls == 5000) " + kForget + kEnd},
    {"another member", kEnd, "  if (++incomplete_ == 300) " + kForget + kEnd},
    {"a long delay", kEnd,
     "  if (late_.push(incomplete_ == 0 ? etlmon::kFalse : etlmon::kTrue).low == etlmon::kBottom "
     "&& "
     "incomplete_ != 0) " +
         kForget + "  incomplete_ = 1;\n" + kEnd},
    {"values that move on", kEnd,
     "  for (uint32_t n = 1; n < 99; ++n) line_[n - 1] = line_[n];\n"
     "  line_[98] = incomplete_ == 0 ? etlmon::kFalse : etlmon::kTrue;\n  incomplete_ = 1;\n"
     "  answer_settled_ = min_of(answer_settled_, line_[0]);\n" +
         kEnd},
    {"the increment", "    ++position_;\n",
     "    ++position_;\n    if (position_ == 120) " + kForget},
};

std::string replaced(std::string text, const std::string& old, const std::string& now) {
    const std::size_t at = text.find(old);
    return at == std::string::npos ? "" : text.replace(at, old.size(), now);
}

TEST(Lengths, LateFaultsAreNotProved) {
    const auto soon = compiled(kSoon, check::Values::robustness);
    ASSERT_TRUE(soon);
    std::string header =
        emit::header(soon->plan, {"proved", library::kVersion, "", "proved.targets.bin"});
    header = replaced(header, "static_assert(sizeof(Monitor) == Monitor::kStateBytes", "");
    header = replaced(header, ", \"the class has no padding\");", "");
    header = replaced(header, kMember, "  etlmon::Delay<Value, 200> late_{};\n" + kMember);
    header = replaced(header, kMember, "  Value line_[99]{};\n" + kMember);
    header = replaced(header, "    position_ = 0;\n",
                      "    position_ = 0;\n    late_.reset(etlmon::kTrue);\n"
                      "    for (Value& one : line_) one = etlmon::kTrue;\n");
    for (const Late& late : kLate) {
        const bool is_right = late.old == late.now;
        std::string changed = replaced(header, late.old, late.now);
        ASSERT_FALSE(changed.empty()) << late.name;
        const auto proof = prove::prove(soon->plan, {changed, "proved", 40});
        ASSERT_TRUE(proof) << late.name << ": " << proof.failure().message;
        EXPECT_FALSE(proof->fault) << late.name;
        EXPECT_EQ(proof->repeats.has_value(), is_right) << late.name << proof->why_not_longer;
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
    EXPECT_TRUE(proof->restarts);
}

}  // namespace
