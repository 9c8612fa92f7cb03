// Tests rows of episodes, differences between specs, and folds, on cases worked out by hand.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "episodes/folds.hpp"
#include "evaluated.hpp"

namespace etlc::tests {
namespace {

using evaluate::Difference;
using evaluate::EpisodeRow;
using evaluate::Judgement;

/// Columns x (p is x <= 0.5) and truth.p, from two words of y and n; "?" is missing.
std::string episode(const std::string& predicted, const std::string& actual) {
    std::string text = "x,truth.p\n";
    for (std::size_t i = 0; i < predicted.size(); ++i)
        text += fmt::format("{},{}\n",
                            predicted[i] == '?'   ? ""
                            : predicted[i] == 'y' ? "0"
                                                  : "1",
                            actual[i] == '?'   ? ""
                            : actual[i] == 'y' ? "1"
                                               : "0");
    return text;
}

const std::string kSpec =
    "spec t; input x : f32; predicate p = x <= 0.5; monitor reach = F p; monitor keep = G p;";

std::string text(const EpisodeRow& row) {
    return fmt::format(
        "{} {} wrong: {} error: {}", row.path.substr(row.path.size() - 8, 4), row.frames,
        fmt::join(row.wrong, " "),
        row.first_error ? fmt::format("{} {}", row.first_error->step, row.first_error->name) : "-");
}

TEST(ByEpisode, IsTheWorstFirst) {
    const auto rows = evaluate::by_episode(judged(
        kSpec, {episode("yyyy", "yyyy"), episode("ynyy", "yyyn"), episode("nnyn", "ynyn"),
                episode("nnnnn", "nyyyy"), episode("yn?y", "ynny"), episode("yyyy", "????")}));
    std::vector<std::string> found;
    for (const EpisodeRow& row : rows) found.push_back(text(row));
    EXPECT_EQ(found, (std::vector<std::string>{
                         "0003 5 wrong: reach error: 1 p",  // wrong verdicts count before fractions
                         "0001 4 wrong:  error: 1 p",       // a half of the frames
                         "0002 4 wrong:  error: 0 p",       // a quarter, as the next one
                         "0004 4 wrong:  error: -",         // a missing sample agrees with nothing
                         "0000 4 wrong:  error: -",
                         "0005 4 wrong:  error: -",  // unknown
                     }));
    EXPECT_EQ(rows[0].predictions.false_negatives, 4U);
    EXPECT_EQ(rows[0].predicates.at(0).first, "p");
}

TEST(ByEpisode, NamesAMonitorWhereNoPredicateErrs) {
    // At its threshold a comparison has robustness 0, which counts as satisfied.
    const auto rows = evaluate::by_episode(
        judged("spec t; input x : f32; monitor m = G x > 0;", {"x\n1\n1\n0\n", "x\n1\n"}));
    ASSERT_TRUE(rows[0].first_error);
    EXPECT_TRUE(rows[0].first_error->of_monitor);
    EXPECT_EQ(text(rows[0]).substr(4), " 3 wrong: m error: 2 m");
    EXPECT_EQ(rows[0].predictions.total(), 3U);  // steps of the monitor
}

TEST(Duration, IsABaselineOfEveryLevel) {
    const auto found = evaluated(
        kSpec, {episode("nny", "nny"), episode("nnyy", "nnyy"), episode("nnyyy", "nnyyy")});
    EXPECT_EQ(found.predicates.at(0).frames.duration->true_positives, 6U);
    EXPECT_EQ(found.predicates.at(0).frames.duration->true_negatives, 6U);
    EXPECT_EQ(found.monitors.at(0).steps.duration->true_positives, 6U);  // F p
    EXPECT_EQ(found.monitors.at(0).episodes.duration->true_positives, 3U);
    EXPECT_EQ(found.monitors.at(1).episodes.duration->true_negatives, 3U);  // G p
}

std::string text(const Difference& d) {
    return fmt::format("{} {} {} {:+.3f}", d.name, d.level, d.other_truths, d.f1.value.value_or(9));
}

TEST(Differences, AreThoseOfEqualNames) {
    const std::vector<std::string> episodes = {episode("yyyn", "yynn"), episode("nyyn", "nyyy"),
                                               episode("nnnn", "nnnn")};
    const Judgement a = judged(kSpec, episodes);
    const std::string always =
        "spec t; input x : f32; predicate p = x <= 9; predicate q = x > 2; monitor reach = F p;";
    const auto found = evaluate::differences(a, judged(always, episodes));
    std::vector<std::string> texts;
    for (const Difference& d : found) texts.push_back(text(d));
    // p: 4 of 5 positives are right, and 4 of 5 true frames are found; always true: 5 of 12, F1 10
    // / 17.
    EXPECT_EQ(texts, (std::vector<std::string>{"p frames 0 -0.212", "reach steps 0 -0.263",
                                               "reach episodes 0 -0.200"}));
    EXPECT_EQ(found[0].auroc->value, 0.0);  // over all thresholds of the distance
    ASSERT_TRUE(found[0].f1.interval);
    EXPECT_LE(found[0].f1.interval->low, *found[0].f1.value);
    // A spec compared with itself has the difference 0 in all resamples.
    for (const Difference& d : evaluate::differences(a, a)) {
        EXPECT_EQ(d.agreement.value, 0.0);
        EXPECT_EQ(d.agreement.interval->low, 0.0);
        EXPECT_EQ(d.agreement.interval->high, 0.0);
    }
}

TEST(Differences, AreNotTakenBetweenDifferentTruths) {
    const std::vector<std::string> episodes = {"x\n0\n1\n", "x\n0\n0\n", "x\n1\n1\n"};
    const std::string spec = "spec t; input x : f32; predicate p = x <= 0.5; monitor reach = F p;";
    const auto found = evaluate::differences(judged(spec + "truth p = x < 0.5;", episodes),
                                             judged(spec + "truth p = x > 0.5;", episodes));
    ASSERT_EQ(found.size(), 3U);
    EXPECT_EQ(text(found[0]), "p frames 3 +9.000");
    EXPECT_EQ(text(found[1]), "reach steps 3 +9.000");
    EXPECT_EQ(text(found[2]), "reach episodes 2 +9.000");
}

TEST(Folds, AreDealtByContentAlone) {
    std::vector<episodes::Recorded> episodes(23);
    std::mt19937 random(6);
    for (std::size_t e = 0; e < episodes.size(); ++e) {
        episodes[e].path = fmt::format("{}.csv", e);
        episodes[e].hash = fmt::format("{:016x}", random());
    }
    const auto deal = [&](const std::vector<std::size_t>& order) {
        episodes::Identities in_order;
        for (const std::size_t e : order) in_order.add(episodes[e]);
        const auto folds = episodes::folds_of(in_order, 5);
        std::vector<std::uint32_t> by_episode(order.size());
        for (std::size_t i = 0; i < order.size(); ++i) by_episode[order[i]] = folds[i];
        return by_episode;
    };
    std::vector<std::size_t> order(episodes.size());
    for (std::size_t e = 0; e < order.size(); ++e) order[e] = e;
    const auto folds = deal(order);
    for (std::uint32_t fold = 0; fold < 5; ++fold)
        EXPECT_EQ(std::count(folds.begin(), folds.end(), fold), fold < 3 ? 5 : 4);
    for (int round = 0; round < 10; ++round) {
        std::shuffle(order.begin(), order.end(), random);
        EXPECT_EQ(deal(order), folds);
    }
}

TEST(Folds, KeepGroupsTogether) {
    std::mt19937 random(7);
    for (int round = 0; round < 200; ++round) {
        std::vector<std::string> groups(1 + random() % 40);
        const std::size_t names = 1 + random() % 12;
        for (std::string& group : groups)
            if (random() % 3 != 0) group = fmt::format("g{}", random() % names);
        const std::size_t folds = 2 + random() % 4;
        const auto of = episodes::dealt(groups, folds);
        std::size_t largest = 1;
        std::size_t apart = 0;
        for (std::size_t a = 0; a < groups.size(); ++a) {
            EXPECT_LT(of[a], folds);
            std::size_t size = 0;
            std::size_t first = a;
            for (std::size_t b = groups.size(); b-- > 0;) {
                if (groups[a].empty() || groups[a] != groups[b]) continue;
                EXPECT_EQ(of[a], of[b]);
                first = std::min(first, b);
                ++size;
            }
            largest = std::max(largest, size);
            apart += first == a ? 1 : 0;
        }
        EXPECT_EQ(episodes::Groups(groups).count(), apart);
        std::vector<std::size_t> sizes(folds);
        for (const std::uint32_t fold : of) ++sizes[fold];
        const auto [least, most] = std::minmax_element(sizes.begin(), sizes.end());
        EXPECT_LE(*most - *least, largest);
        if (apart >= folds) {
            EXPECT_GT(*least, 0U);
        }
    }
}

}  // namespace
}  // namespace etlc::tests
