// Tests a spec that changed after its thresholds were calibrated: either it is refused, or the same
// demonstrations give the same numbers for it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "chains.hpp"
#include "roads.hpp"
#include "whole_specs.hpp"

namespace etlc::tests {
namespace {

using Json = nlohmann::ordered_json;
using Codes = std::vector<std::string>;

const Codes kStaleSpec{"E0652"};

/// A change of a spec. It does not apply to a spec without `from`.
const std::vector<Edit>& spec_edits() {
    static const std::vector<Edit> all{
        {"spec t;", "spec t; // a remark\n"},
        {"rate 10 Hz", "rate 20 Hz"},
        {"rate 10 Hz", "period 100 ms"},
        {"limit = 0.5", "limit = 0.4"},
        {"limit = 0.5", "limit = 0.50"},
        {" in [-9, 9]", ""},
        {" in [-9, 9]", " in [-9, 1]"},
        {" in [-9, 9]", " in [0.4, 9]"},
        {" hold 1", ""},
        {" hold 1", " hold 3"},
        {"y : f32;", "y : f32 hold 1;"},
        {"y : f32;", "y : f32 in [0.1, 0.9];"},
        {"z : f32[2]", "z : f16[2]"},
        {"z : f32[2]", "z : f32[2] hold 2"},
        {"z : f32[2]", "z : f32[2], stale after 1"},
        {"y : f32;", "y : f32, stale after 2;"},
        {"bool missing false", "bool missing true"},
        {"bool missing false", "bool"},
        {"bool missing false", "bool hold 2 missing false"},
        {"Q = [[1, 0.5]", "Q = [[1, 0.6]"},
        {"V = [[2, 0.5]", "V = [[2, 0.4]"},
        {" offset [[0.1, 0]]", ""},
        {" offset [[0.1, 0]]", " offset [[0.1, 0.2]]"},
        {"g = [[0, 0]", "g = [[0, 0.3]"},
        {"[0.2, 0.9]]", "[0.2, 0.9], [0.7, 0.7]]"},
        {"h = [[0.3, 0.1]] of V(z)", "h = [[0.3, 0.1]]"},
        {"h = [[0.3, 0.1]]", "h = [[0.3, 0.2]]"},
        {"k = [[0.4, 0.6]]", "k = [[0.4, 0.5]]"},
        {"min l2(Q(z), g)", "max l2(Q(z), g)"},
        {"min l2(Q(z), g)", "mean l2(Q(z), g)"},
        {"min l2(Q(z), g)", "min l2sq(Q(z), g)"},
        {"min l2(Q(z), g)", "min l2(z, g)"},
        {"min l2(Q(z), g)", "min l2(V(z), g)"},
        {"min l2(Q(z), g)", "min l2(Q(V(z)), g)"},
        {"min l2(Q(z), g)", "min mahalanobis([2, 1])(Q(z), g)"},
        {"min l2(Q(z), g)", "min cosine(V(z), h)"},
        {"kth(2)", "kth(1)"},
        {"kth(2)", "kth(3)"},
        {"kth(2)", "min"},
        {"linf", "l1"},
        {"- 0.1 * x", "- 0.2 * x"},
        {"- 0.1 * x", "+ 0.1 * x"},
        {"- 0.1 * x", "- 0.1 * y"},
        {"- 0.1 * x <=", "- 0.1 * x <"},
        {"- 0.1 * x <=", "- 0.1 * x >="},
        {"- 0.1 * x <=", "- 0.1 * x - 0.1 <="},
        {"y > limit", "y >= limit"},
        {"y > limit", "y < limit"},
        {"y > limit ||", "y > limit &&"},
        {"y > 0.2", "y > 0.3"},
        {"y > 0.2", "x > 0.2"},
        {"&& seen", "&& !seen"},
        {"&& seen", "&& own"},
        {"O[0, 0.2 s]", "O[0, 0.3 s]"},
        {"O[0, 0.2 s]", "H[0, 0.2 s]"},
        {"O[0, 0.2 s]", "O[0, 200 ms]"},
        {"l2([x, y], k)", "l1([x, y], k)"},
        {"l2([x, y], k)", "l2([y, x], k)"},
        {"(b &&", "(!b &&"},
        {"< 0.4)", "< 0.3)"},
        {kTruth, ""},
        {kOwn, kOwn + "truth own = y <= 0.5;\n"},
        {"<= 0.8 missing true", "<= 0.8"},
        {"<= 0.8 missing true", "<= 0.8 missing false"},
        {"<= 0.8", "<= 0.7"},
        {"<= 0.8", "< 0.8"},
        {"x - y", "x - 2 * y"},
        {"<= 1.9 missing false", "<= 1.9 missing true"},
        {"<= 1.9 missing false", "<= 1.9"},
        {"<= 1.9", "<= 1.8"},
        {"<= 1.9", "< 1.9"},
        {"F[0, 0.2 s]", "F[0, 0.3 s]"},
        {"F[0, 0.2 s]", "F[0, 200 ms]"},
        {"F[0, 0.2 s]", "F[0.1 s, 0.2 s]"},
        {"F[0, 0.2 s]", "G[0, 0.2 s]"},
        {"monitor m = F[0", "sliding monitor m = F[0"},
        {"(a && own || a && b)", "(a && own || b)"},
        {"(a && own || a && b)", "(a && own || a && !b)"},
        {"(a && own || a && b)", "(a && b || a && own)"},
        {"(a && own || a && b)", "(a && b)"},
        {"alpha = 0.2", "alpha = 0.15"},
        {"alpha = 0.4", "alpha = 0.3"},
        {"missed_alarm", "missed_success"},
        {"missed_success", "missed_alarm"},
        {"calibrated(f1)", "calibrated(conformal, alpha = 0.2)"},
        {"calibrated(conformal, alpha = 0.2)", "calibrated(class_conditional, alpha = 0.2)"},
        {"calibrated(class_conditional, alpha = 0.2)", "calibrated(f1)"},
        {"gamma = 0.1", "gamma = 0.2"},
        {"lo = -9", "lo = -8"},
        {"hi = 9", "hi = 8"},
        {" <= calibrated", " <= // a remark\n  calibrated"},
    };
    return all;
}

/// Edits that keep the meaning of the spec and need no new calibration.
bool is_harmless(const Edit& edit) {
    return edit.to.find("a remark") != std::string::npos || edit.to.starts_with("gamma") ||
           edit.to.starts_with("lo =") || edit.to.starts_with("hi =") ||
           edit.to.find("200 ms]") != std::string::npos || edit.to == "period 100 ms";
}

TEST(ChangedSpecs, AreRefusedOrGiveTheSameNumbers) {
    Random random(31);
    const Files episodes(random_episodes(random, 24));
    std::vector<int> applied(spec_edits().size());
    int accepted = 0;
    int refused = 0;
    for (const std::string& spec : specs()) {
        const Calibrated before = calibrated(spec, episodes.paths());
        ASSERT_FALSE(before.thresholds.empty()) << testing::PrintToString(before.codes) << spec;
        ASSERT_TRUE(checked(spec, before.thresholds).model)
            << checked(spec, before.thresholds).text;
        for (std::size_t e = 0; e < spec_edits().size(); ++e) {
            const Edit& edit = spec_edits()[e];
            if (spec.find(edit.from) == std::string::npos) continue;
            ++applied[e];
            const std::string changed = replaced(spec, edit.from, edit.to);
            const Checked now = checked(changed, before.thresholds);
            const std::string what = edit.from + " -> " + edit.to + "\n" + spec;
            if (!now.model) {
                ++refused;
                EXPECT_EQ(now.codes, kStaleSpec) << what << now.text;
                EXPECT_FALSE(is_harmless(edit)) << what << now.text;
                continue;
            }
            ++accepted;
            const Calibrated again = calibrated(changed, episodes.paths());
            ASSERT_FALSE(again.thresholds.empty()) << what;
            EXPECT_EQ(numbers(again.thresholds), numbers(before.thresholds)) << what;
        }
    }
    for (std::size_t e = 0; e < spec_edits().size(); ++e)
        EXPECT_GT(applied[e], 0) << spec_edits()[e].from << " -> " << spec_edits()[e].to;
    EXPECT_GT(refused, 300);
    EXPECT_GT(accepted, 20);
}

// ---- monitors that are calibrated as a whole
// -----------------------------------------------------

const std::string kSmall =
    "spec t; input z : f32[2]; input x, y : f32; input b : bool; target t = [[0, 0.5]];\n"
    "predicate a = l2(z, t) <= 0.5 missing false; truth a = y > 0.5;\n"
    "predicate own = x <= 0.9;\n"
    "monitor m = F[0, 2] (a && own || b)\n"
    "    calibrated(conformal, alpha = 0.2, against = missed_alarm);";

struct WholeMonitor : testing::Test {
    Random random{32};
    Files episodes{random_episodes(random, 24)};

    /// Calibrates for one spec, reads for the other, and returns the refusal.
    Checked after(const std::string& spec, const std::string& from, const std::string& to) {
        const Calibrated before = calibrated(spec, episodes.paths());
        EXPECT_FALSE(before.thresholds.empty()) << testing::PrintToString(before.codes);
        EXPECT_TRUE(checked(spec, before.thresholds).model);
        return checked(replaced(spec, from, to), before.thresholds);
    }
    void expect_refused(const std::string& spec, const std::string& from, const std::string& to,
                        const std::string& note) {
        const Checked now = after(spec, from, to);
        EXPECT_EQ(now.codes, kStaleSpec) << from << " -> " << to;
        EXPECT_NE(now.text.find(note), std::string::npos) << now.text;
        EXPECT_NE(now.text.find("calibrate again with 'etlc calibrate'"), std::string::npos);
    }
};

TEST_F(WholeMonitor, WhatAMissingSampleCountsAsBelongsToIt) {
    const std::string is = "predicate a was: l2(z, t) <= 0.5 missing false; it is: l2(z, t) <= 0.5";
    expect_refused(kSmall, "missing false", "missing true", is + " missing true");
    expect_refused(kSmall, "missing false", "", is);
    const std::string none = replaced(kSmall, " missing false", "");
    expect_refused(none, "<= 0.5", "<= 0.5 missing false", "it is: l2(z, t) <= 0.5 missing false");
    expect_refused(none, "<= 0.5", "<= 0.5 missing true", "it is: l2(z, t) <= 0.5 missing true");
}

TEST_F(WholeMonitor, WhatAMissingBoolCountsAsBelongsToIt) {
    expect_refused(kSmall, ": bool", ": bool missing false",
                   "input b was: bool[1]; it is: bool[1] missing false");
    const std::string declared = replaced(kSmall, ": bool", ": bool missing true");
    expect_refused(declared, "bool missing true", "bool missing false",
                   "it is: bool[1] missing fa");
    expect_refused(declared, "bool missing true", "bool", "input b was: bool[1] missing true");
}

TEST_F(WholeMonitor, WhatAPredicateThatIsItsOwnTruthCountsAsBelongsToIt) {
    expect_refused(kSmall, "<= 0.9", "<= 0.9 missing true",
                   "predicate own was: x <= 0.9; it is: x <= 0.9 missing true");
    const std::string declared = replaced(kSmall, "<= 0.9", "<= 0.9 missing false");
    expect_refused(declared, "<= 0.9 missing false", "<= 0.9", "x <= 0.9 missing false; it is: x");
}

TEST_F(WholeMonitor, ItIsSlidingOrNot) {
    expect_refused(kSmall, "monitor m", "sliding monitor m",
                   "monitor m was: monitor; it is: sliding, horizon 2");
    expect_refused(replaced(kSmall, "monitor m", "sliding monitor m"), "sliding monitor m",
                   "monitor m", "monitor m was: sliding, horizon 2; it is: monitor");
}

/// An entry that does not say what its numbers were computed from is of another spec.
TEST_F(WholeMonitor, AnEntryThatReadsLessIsRefused) {
    const std::string thresholds = calibrated(kSmall, episodes.paths()).thresholds;
    const Json file = Json::parse(thresholds);
    for (const auto& [key, text] : file["monitors"]["m"]["reads"].items()) {
        Json less = file;
        less["monitors"]["m"]["reads"].erase(key);
        const Checked now = checked(kSmall, less.dump());
        EXPECT_EQ(now.codes, kStaleSpec) << key;
        EXPECT_NE(now.text.find(key + " was: not read; it is: "), std::string::npos) << now.text;
    }
}

}  // namespace
}  // namespace etlc::tests
