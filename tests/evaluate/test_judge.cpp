// Tests single episodes worked out by hand: detection, ordering, missing samples, omissions.
#include <gtest/gtest.h>

#include "evaluated.hpp"

namespace etlc::tests {
namespace {

using evaluate::Counts;
using evaluate::Evaluation;
using evaluate::MonitorScore;

/// Columns x (p is x <= 0.5) and truth.p, from two words of y and n; "?" is missing.
std::string judged_episode(const std::string& predicted, const std::string& actual) {
    std::string text = "x,truth.p\n";
    for (std::size_t i = 0; i < predicted.size(); ++i) {
        text += predicted[i] == '?' ? "" : predicted[i] == 'y' ? "0" : "1";
        text += actual[i] == '?' ? ",\n" : actual[i] == 'y' ? ",1\n" : ",0\n";
    }
    return text;
}

const std::string kNow = "spec t; input x : f32; predicate p = x <= 0.5; sliding monitor now = p;";

evaluate::Detection detection(const std::string& predicted, const std::string& actual) {
    return evaluated(kNow, {judged_episode(predicted, actual)}).monitors.at(0).detection;
}

TEST(Detection, IsTheTimeFromTurnToTurn) {
    EXPECT_EQ(detection("nnnnyy", "nnyyyy").median, 2.0);
    EXPECT_EQ(detection("nnyyyy", "nnyyyy").median, 0.0);
    EXPECT_EQ(detection("yynnny", "yyynnn").median, -1.0);
    EXPECT_EQ(detection("yynnny", "yyynnn").early, 1U);
    EXPECT_EQ(detection("nynnny", "nnyyyy").median,
              3.0);  // an early claim that was withdrawn does not count
    EXPECT_EQ(detection("?nn?yy", "??nnyy").median, 0.0);
}

TEST(Detection, MayNeverBe) {
    EXPECT_EQ(detection("nnnnnn", "nnyyyy").missed, 1U);
    EXPECT_EQ(detection("nnnnnn", "nnyyyy").median, std::nullopt);
    EXPECT_EQ(detection("nnynnn", "nnnnnn").turns, 0U);
    EXPECT_EQ(detection("nnnyyy", "nn????").turns, 0U);
}

TEST(Judge, CountsWhatAMissingSampleLeavesOpen) {
    const Evaluation found = evaluated(kNow, {judged_episode("yn?ny?", "yyynn?")});
    EXPECT_EQ(found.frames, 6U);
    const Counts expected{1, 1, 1, 1, 1, 0, 1};
    EXPECT_EQ(found.predicates.at(0).frames.counts, expected);
    EXPECT_EQ(found.monitors.at(0).steps.counts, expected);
    EXPECT_EQ(found.predicates.at(0).unmeasured, 1U);
    EXPECT_EQ(found.predicates.at(0).arrays, 1U);
    EXPECT_EQ(found.monitors.at(0).episodes.counts.true_negatives,
              1U);  // not every position satisfies it, nor does the truth
}

TEST(Judge, TheComparisonDecidesAtTheThreshold) {
    const std::string judged_episode = "x,truth.p\n0.5,1\n";
    for (const auto& [comparison, holds] : {std::pair("<=", true), std::pair("<", false),
                                            std::pair(">=", true), std::pair(">", false)}) {
        const Evaluation found = evaluated("spec t; input x : f32; predicate p = x " +
                                               std::string(comparison) + " 0.5; monitor m = F p;",
                                           {judged_episode});
        EXPECT_EQ(found.predicates.at(0).frames.counts.true_positives, holds ? 1U : 0U)
            << comparison;
    }
}

TEST(Judge, RanksByTheSideOfTheThreshold) {
    const std::string judged_episode = "x,truth.p\n0,1\n1,1\n2,0\n3,0\n";
    const std::string spec = "spec t; input x : f32; monitor m = F p; predicate p = x ";
    EXPECT_EQ(evaluated(spec + "<= 9;", {judged_episode}).predicates.at(0).auroc.value, 1.0);
    EXPECT_EQ(evaluated(spec + ">= 9;", {judged_episode}).predicates.at(0).auroc.value, 0.0);
}

TEST(Ordering, IsMeasuredWhereEveryStageWasVisited) {
    const std::string spec =
        "spec t; input x, y : f32; predicate a = x > 0.5; predicate b = y > 0.5;"
        "monitor ordered = F (a && F b); monitor deep = F (a && (y < 9 && F (b && F a))); monitor "
        "reach = F a;"
        "monitor both = F a && F b; monitor in_turn = F (a U b); monitor bounded = F[0, 5] (a && F "
        "b);"
        "monitor two = F (F a && F b);";
    const auto text = [](const std::string& a,
                         const std::string& b) {  // the truth of x and y, which is correct
        std::string rows = "x,y,truth.a,truth.b\n";
        for (std::size_t i = 0; i < a.size(); ++i) {
            const auto bit = [](char c) { return c == 'y' ? std::string("1") : std::string("0"); };
            rows += bit(a[i]) + "," + bit(b[i]) + "," + bit(a[i]) + "," + bit(b[i]) + "\n";
        }
        return rows;
    };
    const Evaluation found =
        evaluated(spec, {text("ynnn", "nnyn"), text("nnyn", "ynnn"), text("nnnn", "ynnn"),
                         text("ynny", "nynn"), text("nyn", "nyn")});
    const auto ordering = [&](std::size_t m) { return found.monitors.at(m).ordering; };
    ASSERT_TRUE(ordering(0));
    EXPECT_EQ(ordering(0)->counts.total(), 4U);  // the third never visits a
    EXPECT_EQ(ordering(0)->counts.positives(), 3U);
    EXPECT_EQ(ordering(0)->counts.negatives(), 1U);
    EXPECT_EQ(ordering(0)->agreement.value, 1.0);
    ASSERT_TRUE(ordering(1));
    EXPECT_EQ(ordering(1)->counts.positives(), 2U);
    for (std::size_t m = 2; m < 7; ++m) EXPECT_FALSE(ordering(m)) << found.monitors[m].name;
}

TEST(Subject, LeavesOutWhatHasNoTruth) {
    const std::string spec =
        "spec t; input z : f32[2]; input x : f32; target g = [[0, 0]]; predicate p = l2(z, g) <= 1;"
        "predicate q = l2(z, g) <= 2; truth q = x > 0; predicate s = x < 1;"
        "monitor m = F p && F q; monitor n = F (q && s); monitor o = F (l2(z, g) <= 3);";
    const Evaluation found = evaluated(spec, {"z[0],z[1],x\n1,1,1\n0,0,0\n"});
    ASSERT_EQ(found.monitors.size(), 3U);
    EXPECT_EQ(found.monitors[0].lacking, std::vector<std::string>{"p"});
    EXPECT_TRUE(found.monitors[1].lacking.empty());
    EXPECT_EQ(found.monitors[2].lacking, std::vector<std::string>{"l2(z, g) <= 3"});
    ASSERT_EQ(found.predicates.size(), 1U);
    EXPECT_EQ(found.predicates[0].name, "q");
    // An array in the episodes is a truth too.
    const Evaluation labelled = evaluated(spec, {"z[0],z[1],x,truth.p\n1,1,1,1\n0,0,0,1\n"});
    EXPECT_TRUE(labelled.monitors[0].lacking.empty());
    EXPECT_EQ(labelled.predicates.size(), 2U);
    EXPECT_EQ(mistakes(spec, {"z[0],z[1],x,truth.p\n1,1,1,1\n", "z[0],z[1],x\n1,1,1\n"}).size(),
              1U);
}

TEST(Evaluate, NamesEveryEpisodeThatCannotBeRead) {
    EXPECT_EQ(mistakes(kNow + "truth p = x < 0.6;", {"x\n1\n", "y\n1\n", "x\na\n"}),
              (std::vector<std::string>{"0001.csv: no column 'x'; there are 'y'",
                                        "0002.csv: column 'x' holds 'a', expected a number"}));
}

TEST(Evaluate, AnEpisodeWithoutStepsIsAMistake) {
    EXPECT_EQ(mistakes(kNow, {judged_episode("", ""), judged_episode("y", "y")}),
              (std::vector<std::string>{"0000.csv: holds no step, expected at least one"}));
}

TEST(Evaluate, CountsEpisodesThatRepeatAnother) {
    EXPECT_EQ(evaluated(kNow, {judged_episode("yn", "yn"), judged_episode("yn", "nn"),
                               judged_episode("ny", "yn")})
                  .repeated,
              1U);
}

TEST(Evaluate, CountsEpisodesWithATargetAmongTheFrames) {
    const std::string spec =
        "spec t; input z : f32[2]; input px : f32; target g = [[1, 0], [3, 4]];"
        "predicate p = min cosine(z, g) <= 0.1; truth p = px < 1; monitor m = F p;";
    const std::string head = "z[0],z[1],px\n";
    EXPECT_EQ(
        evaluated(spec, {head + "3,4.5,0\n", head + "0,1,0\n6,8,0\n", head + "0.5,0,0\n"}).leaked,
        2U);
}

/// At its threshold a comparison has robustness 0, which counts as satisfied, although the
/// comparison may be false.
TEST(Evaluate, OfWhatIsItsOwnTruthTheComparisonDecides) {
    const auto steps = [](const std::string& formula) {
        return evaluated("spec t; input x : f32; monitor m = " + formula + ";", {"x\n1\n0\n"})
            .monitors[0]
            .steps.counts;
    };
    EXPECT_EQ(steps("G x > 0").false_positives, 1U);
    EXPECT_EQ(steps("G !(x <= 0)").false_positives, 1U);
    EXPECT_EQ(steps("G x >= 0").true_positives, 2U);
    EXPECT_EQ(steps("G !(x < 0)").true_positives, 2U);
}

}  // namespace
}  // namespace etlc::tests
