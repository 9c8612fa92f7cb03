// The area under the ROC curve, held to its definition: pairs of frames, counted one by one.
#include "episodes/auroc.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace etlc::episodes {
namespace {

using Weights = std::vector<std::uint32_t>;

constexpr std::uint32_t kEpisodes = 6;

/// Of few scores: ties are common.
std::vector<Scored> random_frames(std::mt19937& random, std::size_t most) {
    std::vector<Scored> frames(random() % most);
    for (Scored& frame : frames)
        frame = {static_cast<float>(random() % 8), static_cast<std::uint32_t>(random() % kEpisodes),
                 random() % 3 == 0};
    return frames;
}

std::optional<double> by_pairs(const std::vector<Scored>& frames, const Weights& folds,
                               const Weights& weights) {
    double ordered = 0;
    double pairs = 0;
    for (const Scored& a : frames) {
        for (const Scored& b : frames) {
            if (!a.positive || b.positive || folds[a.episode] != folds[b.episode]) continue;
            const double times = static_cast<double>(weights[a.episode]) * weights[b.episode];
            pairs += times;
            ordered += times * (a.score > b.score ? 1 : a.score == b.score ? 0.5 : 0);
        }
    }
    if (pairs == 0) return std::nullopt;
    return ordered / pairs;
}

void expect_near(const std::optional<double>& found, const std::optional<double>& expected) {
    ASSERT_EQ(found.has_value(), expected.has_value());
    if (found) {
        EXPECT_NEAR(*found, *expected, 1e-12);
    }
}

TEST(Ranking, CountsPairsOfFramesOfAFold) {
    std::mt19937 random(3);
    for (int round = 0; round < 300; ++round) {
        const std::vector<Scored> frames = random_frames(random, 40);
        Weights weights(kEpisodes);
        for (std::uint32_t& weight : weights) weight = random() % 4;
        const Weights one(kEpisodes, 0);
        const Weights two{0, 1, 0, 1, 0, 1};
        expect_near(Ranking(frames).auroc(weights), by_pairs(frames, one, weights));
        expect_near(Ranking(frames, two).auroc(weights), by_pairs(frames, two, weights));
    }
}

/// The same figure as the ranking's, and for its interval what the ranking says without each
/// episode.
TEST(Auroc, LeavesOutOneEpisodeAtATime) {
    std::mt19937 random(4);
    int intervals = 0;
    for (int round = 0; round < 100; ++round) {
        const std::vector<Scored> frames = random_frames(random, 80);
        const Weights folds{0, 1, 0, 1, 0, 1};
        std::vector<std::vector<RankedFrame>> groups(2);
        std::vector<bool> there(kEpisodes);
        for (const Scored& frame : frames) {
            groups[folds[frame.episode]].push_back({frame, 0, 0});
            there[frame.episode] = true;
        }
        std::vector<std::vector<Scored>> alone(groups.size());
        for (std::size_t g = 0; g < groups.size(); ++g)
            alone[g].assign(groups[g].begin(), groups[g].end());
        const Ranking ranking(frames, folds);
        const auto found = auroc(groups, kEpisodes);
        const auto same = auroc(alone, kEpisodes);
        ASSERT_EQ(same.has_value(), found.has_value());
        const auto value = ranking.auroc(Weights(kEpisodes, 1));
        expect_near(found ? std::optional(found->value) : std::nullopt, value);
        std::vector<double> without;
        for (std::uint32_t e = 0; e < kEpisodes; ++e) {
            Weights weights(kEpisodes, 1);
            weights[e] = 0;
            if (!there[e]) continue;
            if (const auto one = ranking.auroc(weights)) without.push_back(*one);
        }
        if (!found) continue;
        EXPECT_EQ(same->value, found->value);
        ASSERT_EQ(same->interval.has_value(), found->interval.has_value());
        if (!found->interval) continue;
        EXPECT_EQ(same->interval->low, found->interval->low);
        EXPECT_EQ(same->interval->high, found->interval->high);
        ++intervals;
        const auto n = static_cast<double>(without.size());
        double mean = 0;
        double squares = 0;
        for (const double one : without) mean += one / n;
        for (const double one : without) squares += (one - mean) * (one - mean);
        const double margin = 1.96 * std::sqrt((n - 1) / n * squares);
        EXPECT_NEAR(found->interval->low, std::max(0.0, *value - margin), 1e-12);
        EXPECT_NEAR(found->interval->high, std::min(1.0, *value + margin), 1e-12);
    }
    EXPECT_GT(intervals, 50);
}

TEST(Auroc, SaysOfEachFrameHowManyPairsAreInOrder) {
    using Frames = std::vector<RankedFrame>;
    // The second group is of another scale.
    std::vector<Frames> groups{Frames{{{3, 0, true}, 0}, {{2, 0, false}, 1}, {{2, 0, true}, 2}},
                               Frames{{{80, 1, false}, 0}, {{70, 1, true}, 1}}};
    const auto found = auroc(groups, 2);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->value, (1 + 0.5 + 0) / 3);
    EXPECT_FALSE(found->interval) << "two episodes do not give one";
    EXPECT_EQ(groups[0].back().ordered, 1) << "sorted by score";
    EXPECT_EQ(groups[1].front().ordered, 0);
    std::vector<Frames> alike{Frames{{{1, 0, true}, 0}, {{2, 0, true}, 1}}};
    EXPECT_FALSE(auroc(alike, 1));
}

}  // namespace
}  // namespace etlc::episodes
