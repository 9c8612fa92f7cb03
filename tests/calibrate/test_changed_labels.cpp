// Labels from another source than the spec now names, and fits to frames that they selected:
// thresholds and fits are refused, with the old and the new source in the message.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "chains.hpp"
#include "roads.hpp"
#include "whole_specs.hpp"

namespace etlc::tests {
namespace {

using Codes = std::vector<std::string>;

const Codes kStale{"E0652"};

// ---- where labels come from ---------------------------------------------------------------------

struct Labelled : testing::Test {
    Random random{34};
    Files arrays{random_episodes(random, 24, true)};

    void expect_refused(const std::string& spec, const std::string& thresholds,
                        const std::string& note) {
        const Checked now = checked(spec, thresholds);
        EXPECT_EQ(now.codes, kStale) << spec;
        EXPECT_NE(now.text.find(note), std::string::npos) << now.text;
    }
};

TEST_F(Labelled, ByArraysAndThenATruthIsStated) {
    for (const std::string& spec : specs()) {
        const std::string silent = replaced(spec, kTruth, "");
        const Calibrated before = calibrated(silent, arrays.paths());
        ASSERT_FALSE(before.thresholds.empty()) << testing::PrintToString(before.codes);
        EXPECT_TRUE(checked(silent, before.thresholds).model);
        expect_refused(spec, before.thresholds,
                       "truth a was: an array or table; it is: y > 0.5 ||");
    }
}

TEST_F(Labelled, ByArraysInPlaceOfATruthThatIsChangedOrRemoved) {
    for (const std::string& spec : specs()) {
        const Calibrated before = calibrated(spec, arrays.paths());
        ASSERT_FALSE(before.thresholds.empty()) << testing::PrintToString(before.codes);
        // Unchanged, it is accepted, and names the source of the labels.
        const Checked same = checked(spec, before.thresholds);
        ASSERT_TRUE(same.model) << same.text;
        ASSERT_EQ(same.model->reservations.size(), 1U);
        EXPECT_NE(same.model->reservations[0].find("calibrated on labels from arrays"),
                  std::string::npos);
        expect_refused(replaced(spec, "y > limit", "y >= limit"), before.thresholds,
                       "truth a was: an array or table in place of y > 0.5 || y > 0.2 &&");
        expect_refused(replaced(spec, kTruth, ""), before.thresholds,
                       "in place of y > 0.5 || y > 0.2 &&");
    }
}

TEST_F(Labelled, InPartByArrays) {
    Files some(random_episodes(random, 12, true));
    for (const std::string& episode : random_episodes(random, 12)) some.add(episode);
    for (const std::string& spec : specs()) {
        const Calibrated before = calibrated(spec, some.paths());
        ASSERT_FALSE(before.thresholds.empty()) << testing::PrintToString(before.codes);
        const Checked same = checked(spec, before.thresholds);
        ASSERT_TRUE(same.model) << same.text;
        EXPECT_EQ(same.model->reservations.size(), 1U);
        expect_refused(replaced(spec, "y > limit", "y >= limit"), before.thresholds,
                       "an array or table, or y > 0.5 || y > 0.2 &&");
        expect_refused(replaced(spec, kTruth, ""), before.thresholds,
                       "an array or table, or y > 0.5");
    }
}

TEST_F(Labelled, ByATruthThatIsRemoved) {
    const Files plain(random_episodes(random, 24));
    for (const std::string& spec : specs())
        expect_refused(replaced(spec, kTruth, ""), calibrated(spec, plain.paths()).thresholds,
                       "; it is: an array or table\n");
}

// ---- what is fitted -----------------------------------------------------------------------------

/// Every method, and each kind of predicate that selects frames.
const std::string kFitted =
    "spec t; input z : f32[2] hold 1; input x, y : f32; input b : bool; target t = [[0, 0.5]];\n"
    "projection P = {}; target u = fitted(mean, of = P(z), where = a);\n"
    "predicate a = l2(P(z), u) <= 0.5; truth a = y > 0.5 && (b || l2([x, y], t) < 2);\n"
    "predicate own = x <= 0.9; let often = a && own;\n"
    "target f = {};\n"
    "predicate c = min l2(z, f) <= 0.7; predicate d = {}(z, t) <= 1;\n"
    "monitor m = F (a && c && d);";

std::vector<std::string> fitted_specs() {
    std::vector<std::string> all;
    const std::string by = "of = z, where = often)";
    for (const char* method : {"mean, ", "medoids, k = 2, ", "kmeans, k = 2, "})
        all.push_back(fmt::format(fmt::runtime(kFitted), "[[1, 0], [0, 2]]",
                                  "fitted(" + (method + by), "l2"));
    for (const char* method : {"pca, r = 1, ", "whitened_pca, r = 2, ", "logpzo, "})
        all.push_back(
            fmt::format(fmt::runtime(kFitted), "fitted(" + (method + by), "[[1, 0]]", "l2"));
    all.push_back(fmt::format(fmt::runtime(kFitted), "fitted(discriminant, r = 1, " + by,
                              "[[1, 0]]", "mahalanobis(fitted(discriminant, " + by + ")"));
    return all;
}

TEST(ChangedSpecs, WhatIsFittedIsRefusedOrTheSame) {
    Random random(35);
    const Files episodes(random_episodes(random, 24));
    const std::vector<Edit> changes{
        {"spec t;", "spec t; // a remark\n"},
        {"spec t;", "spec t; rate 10 Hz;"},
        {"hold 1", "hold 2"},
        {"hold 1", "hold 1, stale after 3"},
        {"f32[2] hold 1", "f16[2] hold 1"},
        {"x, y : f32", "x, y : f32 in [0, 0.7]"},
        {"[[1, 0], [0, 2]]", "[[1, 0], [0, 3]]"},
        {"l2(P(z), u)", "l1(P(z), u)"},
        {"<= 0.5; truth", "<= 0.6 missing true; truth"},
        {"y > 0.5", "y > 0.4"},
        {"b ||", "b &&"},
        {": bool", ": bool hold 1"},
        {"t = [[0, 0.5]]", "t = [[0, 0.6]]"},
        {"l2([x, y], t)", "l1([x, y], t)"},
        {"own = x <= 0.9", "own = x <= 0.8"},
        {"own = x <= 0.9", "own = x - y <= 0.9"},
        {"let often", "truth own = y > 0.4; let often"},
        {"often = a && own", "often = a || own"},
        {"truth a = y > 0.5 && (b || l2([x, y], t) < 2);", ""},
    };
    int refused = 0;
    int accepted = 0;
    for (const std::string& spec : fitted_specs()) {
        const std::string before = fitted(spec, episodes.paths());
        ASSERT_FALSE(before.empty()) << spec;
        ASSERT_TRUE(checked(spec, "", before).model) << checked(spec, "", before).text;
        for (const Edit& edit : changes) {
            if (spec.find(edit.from) == std::string::npos) continue;
            const std::string changed = replaced(spec, edit.from, edit.to);
            const Checked now = checked(changed, "", before);
            ++(now.model ? accepted : refused);
            if (now.model)
                EXPECT_EQ(fitted(changed, episodes.paths()), before) << changed;
            else
                EXPECT_EQ(now.codes, Codes{"E0607"}) << now.text;
        }
    }
    EXPECT_GT(refused, 80);
    EXPECT_GE(accepted, 7);
}

TEST_F(Labelled, ChoseTheFramesThatWereFitted) {
    const std::string truth = "truth a = y > 0.5 && (b || l2([x, y], t) < 2);";
    Files some(random_episodes(random, 8, true));
    for (const std::string& episode : random_episodes(random, 8)) some.add(episode);
    for (const std::string& spec : fitted_specs()) {
        const std::string silent = replaced(spec, truth, "");
        const auto expect_stale = [&](const std::string& now, const std::string& file,
                                      const std::string& note) {
            const Checked read = checked(now, "", file);
            EXPECT_EQ(read.codes, Codes{"E0607"}) << now;
            EXPECT_NE(read.text.find(note), std::string::npos) << read.text;
        };
        const std::string without = fitted(silent, arrays.paths());
        EXPECT_TRUE(checked(silent, "", without).model) << checked(silent, "", without).text;
        expect_stale(spec, without, "truth a was: an array or table");

        const std::string in_place = fitted(spec, arrays.paths());
        EXPECT_TRUE(checked(spec, "", in_place).model) << checked(spec, "", in_place).text;
        expect_stale(silent, in_place, "truth a was: an array or table in place of y > 0.5");
        expect_stale(replaced(spec, "y > 0.5", "y > 0.4"), in_place,
                     "truth a was: an array or table in place of y > 0");

        const std::string partly = fitted(spec, some.paths());
        EXPECT_TRUE(checked(spec, "", partly).model) << checked(spec, "", partly).text;
        expect_stale(silent, partly, "truth a was: an array or table, or y > 0.5");
    }
}

}  // namespace
}  // namespace etlc::tests
