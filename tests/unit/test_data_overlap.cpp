// Tests which episodes are the same recording, in whole or in part.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>

#include "data/traces/overlap.hpp"

namespace etlc::data {
namespace {

using Numbers = std::vector<float>;

InputContent content_of(const Numbers& samples, bool tells_alone) {
    ContentReader reader(tells_alone);
    for (const float sample : samples) {
        const auto bits = std::bit_cast<std::uint32_t>(sample);
        reader.add(&bits, 1, sample == sample);
    }
    return reader.content();
}

EpisodeContent episode(const Numbers& samples) {
    return {{"z", content_of(samples, true)}};
}

Numbers random_numbers(std::size_t n, unsigned seed) {
    std::mt19937 random(seed);
    Numbers numbers(n);
    for (float& number : numbers) number = std::uniform_real_distribution<float>(0, 1)(random);
    return numbers;
}

Numbers piece(const Numbers& of, std::size_t begin, std::size_t n) {
    const auto from = of.begin() + static_cast<std::ptrdiff_t>(begin);
    return {from, from + static_cast<std::ptrdiff_t>(n)};
}

Numbers joined(Numbers a, const Numbers& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

std::optional<Overlap> found(const EpisodeContent& a, const EpisodeContent& b) {
    Recordings recordings;
    recordings.add(a);
    return recordings.find(b);
}

TEST(Overlap, WholesAndPieces) {
    for (const std::size_t n : {20U, 200U, 20000U}) {
        const Numbers whole = random_numbers(n, 1);
        const auto equal = found(episode(whole), episode(whole));
        ASSERT_TRUE(equal) << n;
        EXPECT_TRUE(equal->equal);
        const auto less = found(episode(whole), episode(piece(whole, 0, n - 1)));
        ASSERT_TRUE(less) << n;
        EXPECT_FALSE(less->equal);
        EXPECT_GT(less->share, 0.95);
        EXPECT_TRUE(found(episode(piece(whole, n / 5, n / 2)), episode(whole))) << n;
        EXPECT_FALSE(found(episode(whole), episode(random_numbers(n, 2)))) << n;
    }
}

TEST(Overlap, IsMoreThanHalfOfTheSmaller) {
    // Too few for a sample: all are counted.
    const Numbers a = random_numbers(40, 1);
    const Numbers others = random_numbers(100, 2);
    for (const std::size_t shared : {1U, 10U, 19U, 20U, 21U, 30U}) {
        const Numbers b = joined(piece(a, 0, shared), piece(others, 0, 40 - shared));
        const auto overlap = found(episode(a), episode(b));
        EXPECT_EQ(overlap.has_value(), shared > 20) << shared;
        if (overlap) {
            EXPECT_DOUBLE_EQ(overlap->share, static_cast<double>(shared) / 40);
        }
    }
    // A long episode does not hide a short one.
    EXPECT_TRUE(found(episode(joined(others, piece(a, 0, 32))), episode(a)));
    EXPECT_FALSE(found(episode(joined(others, piece(a, 0, 8))), episode(a)));
}

TEST(Overlap, EstimatesSharesOfLongEpisodes) {
    for (unsigned seed = 0; seed < 20; ++seed) {
        const Numbers a = random_numbers(20000, 3 * seed);
        const Numbers b = random_numbers(20000, 3 * seed + 1);
        const auto of = [&](std::size_t shared) {
            return share(
                content_of(a, true).sketch,
                content_of(joined(piece(a, 0, shared), piece(b, 0, 20000 - shared)), true).sketch);
        };
        EXPECT_NEAR(*of(4000), 0.2, 0.06);
        EXPECT_NEAR(*of(14000), 0.7, 0.06);
        // A piece of 300 is found among 20000.
        EXPECT_TRUE(found(episode(a), episode(piece(a, 5000, 300)))) << seed;
    }
}

TEST(Overlap, FramesCountOnce) {
    // Standing still for long at a common place counts as one common frame.
    const Numbers still(500, 0.25F);
    EXPECT_FALSE(found(episode(joined(still, random_numbers(30, 1))),
                       episode(joined(still, random_numbers(30, 2)))));
}

TEST(Overlap, OfShortEpisodesTwoFramesAreEnough) {
    const Numbers a = random_numbers(7, 1);
    const Numbers others = random_numbers(7, 2);
    for (std::size_t n = 2; n <= 7; ++n)
        for (std::size_t shared = 0; shared <= n; ++shared) {
            const Numbers b = joined(piece(a, 0, shared), piece(others, 0, n - shared));
            const bool expected = shared >= 2 && 2 * shared > n;
            EXPECT_EQ(found(episode(piece(a, 0, n)), episode(b)).has_value(), expected)
                << n << ' ' << shared;
        }
    // Missing frames are not shared.
    const Numbers missing(20, NAN);
    EXPECT_FALSE(found(episode(joined(missing, piece(a, 0, 3))),
                       episode(joined(missing, piece(others, 0, 3)))));
    EXPECT_TRUE(
        found(episode(joined(missing, piece(a, 0, 3))), episode(joined(piece(a, 0, 3), missing))));
    // A world of few images: they recur in every episode.
    const Numbers world = random_numbers(3, 4);
    EXPECT_FALSE(found(episode(joined(joined(world, world), world)),
                       episode(joined(joined(world, piece(world, 0, 1)), joined(world, world)))));
    // If another input has more units, a few frames of this one do not count.
    const auto both = [](const Numbers& z, const Numbers& w) {
        return EpisodeContent{{"z", content_of(z, true)}, {"w", content_of(w, true)}};
    };
    EXPECT_TRUE(found(both(random_numbers(50, 3), piece(a, 0, 2)),
                      both(random_numbers(50, 3), piece(others, 0, 2))));
}

TEST(Overlap, ScalarsTellByRuns) {
    const auto scalar = [](const Numbers& samples) {
        return EpisodeContent{{"x", content_of(samples, false)}};
    };
    const auto digits = [](std::size_t n, unsigned seed) {  // the same sixteen in all
        std::mt19937 random(seed);
        Numbers numbers(n);
        for (float& number : numbers) number = static_cast<float>(random() % 16);
        return numbers;
    };
    const Numbers a = digits(200, 1);
    EXPECT_FALSE(found(scalar(a), scalar(digits(200, 2))));
    EXPECT_TRUE(found(scalar(a), scalar(piece(a, 0, 199))));
    // A single step does not count unless it is equal.
    const Numbers step = joined(Numbers(100, 0), Numbers(100, 1));
    EXPECT_FALSE(found(scalar(step), scalar(piece(step, 0, 199))));
    EXPECT_TRUE(found(scalar(step), scalar(step)));
}

TEST(Overlap, LooksAtCommonInputs) {
    const Numbers z = random_numbers(50, 1);
    const Numbers w = random_numbers(50, 2);
    const EpisodeContent both{{"z", content_of(z, true)}, {"w", content_of(w, true)}};
    EXPECT_TRUE(found(both, episode(z))->equal);
    EXPECT_TRUE(found(episode(z), both)->equal);
    EXPECT_FALSE(found(both, EpisodeContent{}));
    EXPECT_FALSE(found(both, EpisodeContent{{"v", content_of(z, true)}}));
    // A camera that saw the same wall is not a common recording.
    const EpisodeContent other{{"z", content_of(random_numbers(50, 3), true)},
                               {"w", content_of(w, true)}};
    EXPECT_FALSE(found(both, other));
}

TEST(Overlap, FindsTheEqualOneBeforeAPart) {
    const Numbers a = random_numbers(50, 1);
    Recordings recordings;
    recordings.add(episode(piece(a, 0, 40)));
    recordings.add(episode(random_numbers(50, 2)));
    recordings.add(episode(a));
    const auto overlap = recordings.find(episode(a));
    ASSERT_TRUE(overlap);
    EXPECT_TRUE(overlap->equal);
    EXPECT_EQ(overlap->other, 2U);
}

TEST(Overlap, SketchesAreTheSameWhateverTheOrderOfCompaction) {
    // More units than are held before they are thinned out.
    Numbers a = random_numbers(60000, 1);
    const Sketch forwards = content_of(a, true).sketch;
    std::reverse(a.begin(), a.end());
    EXPECT_EQ(content_of(a, true).sketch, forwards);
    EXPECT_GT(forwards.size(), 60000U / 20);
    EXPECT_LT(forwards.size(), 60000U / 12);
}

}  // namespace
}  // namespace etlc::data
