// Compares the area under the ROC curve with its definition: pairs of frames, counted one by one.
#include "episodes/ranking/auroc.hpp"

#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>
#include <limits>
#include <random>

namespace etlc::episodes {
namespace {

using PerEpisode = std::vector<std::uint32_t>;

constexpr std::uint32_t kEpisodes = 6;

/// Few distinct scores, so ties are common.
std::vector<Scored> random_frames(std::mt19937& random, std::size_t most) {
    std::vector<Scored> frames(random() % most);
    for (Scored& frame : frames)
        frame = {static_cast<float>(random() % 8), static_cast<std::uint32_t>(random() % kEpisodes),
                 random() % 3 == 0};
    return frames;
}

std::optional<double> by_pairs(const std::vector<Scored>& frames, const PerEpisode& folds,
                               const PerEpisode& weights) {
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

/// Returns the figures of the resamples `weights`.
std::vector<std::optional<double>> resampled(const std::vector<Scored>& frames,
                                             const PerEpisode& folds,
                                             const std::vector<PerEpisode>& weights) {
    std::vector<FramesByScore> groups(2);
    for (const Scored& frame : frames) groups[folds[frame.episode]].add(frame);
    Weights all(kEpisodes, weights.size(), 0);
    for (std::size_t r = 0; r < weights.size(); ++r)
        for (std::size_t e = 0; e < kEpisodes; ++e)
            all[e][r] = static_cast<Weights::Weight>(weights[r][e]);
    return auroc(groups, all);
}

TEST(Auroc, CountsPairsOfFramesOfAFoldInEveryResample) {
    std::mt19937 random(3);
    for (int round = 0; round < 300; ++round) {
        const std::vector<Scored> frames = random_frames(random, 40);
        std::vector<PerEpisode> weights(5, PerEpisode(kEpisodes));
        for (PerEpisode& resample : weights)
            for (std::uint32_t& weight : resample) weight = random() % 4;
        for (const PerEpisode& folds :
             {PerEpisode{0, 0, 0, 0, 0, 0}, PerEpisode{0, 1, 0, 1, 0, 1}}) {
            const auto found = resampled(frames, folds, weights);
            for (std::size_t r = 0; r < weights.size(); ++r)
                expect_near(found[r], by_pairs(frames, folds, weights[r]));
        }
    }
}

TEST(FramesByScore, KeepsScoresAndTheirOrder) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    const std::vector<float> ascending{-kInfinity, -FLT_MAX, -1.5F,   -1e-45F,  0,
                                       1e-45F,     1.5F,     FLT_MAX, kInfinity};
    FramesByScore frames;
    for (std::uint32_t i = 0; i < ascending.size(); ++i)
        frames.add({ascending[ascending.size() - 1 - i], i, i % 2 == 0});
    frames.add({-0.0F, 2'000'000'000, true});
    std::vector<float> found;
    frames.for_each([&](const Scored& frame) {
        if (frame.episode == 2'000'000'000) {
            EXPECT_TRUE(frame.positive);
            EXPECT_FALSE(std::signbit(frame.score));
            return;
        }
        EXPECT_EQ(frame.positive, frame.episode % 2 == 0);
        EXPECT_EQ(frame.score, ascending[ascending.size() - 1 - frame.episode]);
        found.push_back(frame.score);
    });
    EXPECT_EQ(found, ascending);
    EXPECT_EQ(frames.positives(), 6U);
    EXPECT_EQ(frames.negatives(), 4U);
}

/// The figure equals the count of pairs, and the interval those without each episode.
TEST(Auroc, LeavesOutOneEpisodeAtATime) {
    std::mt19937 random(4);
    int intervals = 0;
    for (int round = 0; round < 100; ++round) {
        const std::vector<Scored> frames = random_frames(random, 80);
        const PerEpisode folds =
            round % 2 == 0 ? PerEpisode(kEpisodes) : PerEpisode{0, 1, 0, 1, 0, 1};
        std::vector<std::vector<RankedFrame>> groups(2);
        FramesByScore negated;
        std::vector<bool> there(kEpisodes);
        for (const Scored& frame : frames) {
            groups[folds[frame.episode]].push_back({frame, 0, 0});
            negated.add({-frame.score, frame.episode, frame.positive});
            there[frame.episode] = true;
        }
        const auto found = auroc(groups, kEpisodes);
        const auto value = by_pairs(frames, folds, PerEpisode(kEpisodes, 1));
        expect_near(found.value, value);
        if (folds[1] == 0) {
            const auto same = auroc(negated, kEpisodes);
            EXPECT_EQ(same.value, found.value);
            ASSERT_EQ(same.interval.has_value(), found.interval.has_value());
            if (found.interval) {
                EXPECT_EQ(same.interval->low, found.interval->low);
                EXPECT_EQ(same.interval->high, found.interval->high);
            }
        }
        std::vector<double> without;
        for (std::uint32_t e = 0; e < kEpisodes; ++e) {
            PerEpisode weights(kEpisodes, 1);
            weights[e] = 0;
            if (!there[e]) continue;
            if (const auto one = by_pairs(frames, folds, weights)) without.push_back(*one);
        }
        if (!found.interval) continue;
        ++intervals;
        const auto n = static_cast<double>(without.size());
        double mean = 0;
        double squares = 0;
        for (const double one : without) mean += one / n;
        for (const double one : without) squares += (one - mean) * (one - mean);
        const double margin = 1.96 * std::sqrt((n - 1) / n * squares);
        EXPECT_NEAR(found.interval->low, std::max(0.0, *value - margin), 1e-12);
        EXPECT_NEAR(found.interval->high, std::min(1.0, *value + margin), 1e-12);
    }
    EXPECT_GT(intervals, 50);
}

TEST(Auroc, SaysOfEachFrameHowManyPairsAreInOrder) {
    using Frames = std::vector<RankedFrame>;
    // The second group has another scale.
    std::vector<Frames> groups{Frames{{{3, 0, true}, 0}, {{2, 0, false}, 1}, {{2, 0, true}, 2}},
                               Frames{{{80, 1, false}, 0}, {{70, 1, true}, 1}}};
    const auto found = auroc(groups, 2);
    EXPECT_EQ(found.value, (1 + 0.5 + 0) / 3);
    EXPECT_FALSE(found.interval) << "two episodes do not give one";
    EXPECT_EQ(groups[0].back().ordered, 1) << "sorted by score";
    EXPECT_EQ(groups[1].front().ordered, 0);
    std::vector<Frames> alike{Frames{{{1, 0, true}, 0}, {{2, 0, true}, 1}}};
    EXPECT_FALSE(auroc(alike, 1).value);
}

}  // namespace
}  // namespace etlc::episodes
