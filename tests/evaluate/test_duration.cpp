// Tests the duration baseline: small cases by hand, random ones by trying every threshold.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>

#include "evaluate/figures.hpp"

namespace etlc::evaluate {
namespace {

Label label(char c) {
    return c == 'y' ? Label::yes : c == 'n' ? Label::no : Label::unknown;
}

/// A word of y, n and ?, one label per step.
LabelRuns steps(const std::string& word) {
    LabelRuns runs;
    for (const char c : word) runs.add(label(c));
    return runs;
}

/// An episode with this many steps.
LabelRuns whole(std::uint64_t length, char is) {
    LabelRuns runs(length);
    runs.add(label(is));
    return runs;
}

std::optional<Counts> judged(const std::vector<LabelRuns>& episodes) {
    return judged_by_duration([&](const std::function<void(const LabelRuns&)>& visit) {
        for (const LabelRuns& episode : episodes) visit(episode);
    });
}

struct Right {
    std::uint64_t positives = 0;
    std::uint64_t negatives = 0;
    bool operator==(const Right&) const = default;
};

/// Counts the true and the false labels that the duration gets right.
std::optional<Right> right(const std::vector<LabelRuns>& episodes) {
    const auto counts = judged(episodes);
    if (!counts) return std::nullopt;
    return Right{counts->true_positives, counts->true_negatives};
}

TEST(Duration, SeparatesWhatLastsLonger) {
    // Without 110 the threshold is between 100 and 200, without 200 between 110 and 210.
    EXPECT_EQ(right({whole(100, 'y'), whole(110, 'y'), whole(200, 'n'), whole(210, 'n')}),
              (Right{2, 2}));
    EXPECT_EQ(right({whole(210, 'y'), whole(100, 'n'), whole(200, 'y'), whole(110, 'n')}),
              (Right{2, 2}));
}

TEST(Duration, OfAStepIsItsNumber) {
    EXPECT_EQ(right({steps("nnnyyy"), steps("nnnyyyyy"), steps("nnny")}), (Right{9, 9}));
    EXPECT_EQ(right({steps("yynnnn"), steps("yynnn"), steps("yynn")}), (Right{6, 9}));
}

TEST(Duration, HasNotSeenTheEpisodeThatItJudges) {
    // The two contradict each other.
    EXPECT_EQ(right({steps("yn"), steps("ny")}), (Right{0, 0}));
    // Without the only failure, all succeed.
    EXPECT_EQ(right({whole(5, 'y'), whole(6, 'y'), whole(9, 'n')}), (Right{2, 0}));
    EXPECT_EQ(right({steps("nnyy")}), std::nullopt);
    EXPECT_EQ(right({whole(5, 'y'), whole(6, '?')}), std::nullopt);
    EXPECT_EQ(right({}), std::nullopt);
}

TEST(Duration, IsAlwaysTrueOrFalseWhereNoThresholdIsBetter) {
    EXPECT_EQ(right({steps("yyy"), steps("yyyyyy"), steps("y")}), (Right{10, 0}));
    EXPECT_EQ(right({steps("nnn"), steps("nnnnnn"), steps("n")}), (Right{0, 10}));
    // Two of three are true at every step: always true gets 4 / 5, and no threshold gets more.
    EXPECT_EQ(right({steps("yy"), steps("yy"), steps("yy"), steps("nn")}), (Right{6, 0}));
}

TEST(Duration, LeavesOutWhatIsNotKnown) {
    const auto counts = judged({steps("n?yy"), steps("nn?y"), steps("?nyy")});
    ASSERT_TRUE(counts);
    EXPECT_EQ(counts->unlabelled, 3U);
    EXPECT_EQ(counts->total(), 9U);
    EXPECT_EQ(counts->true_positives, 5U);
}

/// A label and its number.
using Labelled = std::pair<std::uint64_t, Label>;

std::vector<Labelled> labels_of(const LabelRuns& episode) {
    std::vector<Labelled> labels;
    for (const LabelRuns::Run& run : episode.runs())
        for (std::uint64_t number = run.begin; number < run.end; ++number)
            labels.emplace_back(number, run.label);
    return labels;
}

/// Twice the two ends: true from the one and below the other.
struct Rule {
    std::uint64_t from = 0;
    std::uint64_t below = kEndless;
    static constexpr std::uint64_t kEndless = 1000;

    bool says(std::uint64_t number) const { return from <= 2 * number && 2 * number < below; }
};

/// F1, then the number that agree.
std::pair<double, std::uint64_t> merit(const Rule& rule, const std::vector<Labelled>& labels) {
    Counts counts;
    for (const auto& [number, is] : labels)
        counts.add(rule.says(number) ? Label::yes : Label::no, is);
    return {rates(counts).f1.value_or(0), counts.true_positives + counts.true_negatives};
}

/// Tries always, never, and all first and last numbers that are true.
Rule best(const std::vector<Labelled>& labels, std::uint64_t greatest) {
    Rule best;
    const auto better = [&](const Rule& a, const Rule& b) {
        return merit(a, labels) > merit(b, labels);
    };
    if (better({0, 0}, best)) best = {0, 0};
    const auto is_labelled = [&](std::uint64_t number) {
        return std::any_of(labels.begin(), labels.end(),
                           [&](const Labelled& one) { return one.first == number; });
    };
    for (std::uint64_t last = 0; last <= greatest; ++last)
        for (std::uint64_t first = last + 1; first-- > 0;) {
            if (!is_labelled(first) || !is_labelled(last)) continue;
            if (!better({2 * first, 2 * last + 1}, best)) continue;
            best = {2 * first, 2 * last + 1};
        }
    if (best.below == 0 || best.below == Rule::kEndless) return best;
    // Each end moves halfway to the next label, away from the first and the last one.
    const std::uint64_t last = best.below / 2;
    const std::uint64_t first = best.from / 2;
    std::uint64_t before = first;
    while (before > 0 && !is_labelled(before - 1)) --before;
    std::uint64_t after = last + 1;
    while (after <= greatest && !is_labelled(after)) ++after;
    return {before == 0 ? 0 : before + first, after > greatest ? Rule::kEndless : last + 1 + after};
}

TEST(Duration, IsTheBestThresholdOnAllOtherEpisodes) {
    std::mt19937 random(5);
    for (int round = 0; round < 300; ++round) {
        std::vector<LabelRuns> episodes;
        const bool of_wholes = round % 2 == 0;
        for (std::size_t e = 0; e < 2 + random() % 6; ++e) {
            const auto draw = [&] {
                return random() % 8 == 0 ? '?' : random() % 2 == 0 ? 'y' : 'n';
            };
            std::string word(1 + random() % 8, draw());
            for (std::size_t i = 1; i < word.size(); ++i)
                word[i] = random() % 3 == 0 ? draw() : word[i - 1];
            episodes.push_back(of_wholes ? whole(1 + random() % 20, draw()) : steps(word));
        }
        Counts expected;
        bool all_have_others = true;
        for (std::size_t left = 0; left < episodes.size(); ++left) {
            std::vector<Labelled> others;
            for (std::size_t e = 0; e < episodes.size(); ++e)
                for (const Labelled& one : labels_of(episodes[e]))
                    if (e != left && one.second != Label::unknown) others.push_back(one);
            all_have_others = all_have_others && !others.empty();
            const Rule rule = best(others, 25);
            for (const auto& [number, is] : labels_of(episodes[left]))
                expected.add(rule.says(number) ? Label::yes : Label::no, is);
        }
        const auto found = judged(episodes);
        ASSERT_EQ(found.has_value(), all_have_others && expected.total() > 0);
        if (found) {
            EXPECT_EQ(*found, expected) << round;
        }
    }
}

}  // namespace
}  // namespace etlc::evaluate
