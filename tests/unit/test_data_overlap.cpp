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
    // A few other frames of one input do not hide that another is the same.
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
    // One of two embeddings is enough.
    const EpisodeContent other{{"z", content_of(random_numbers(50, 3), true)},
                               {"w", content_of(w, true)}};
    const auto overlap = found(both, other);
    ASSERT_TRUE(overlap);
    EXPECT_FALSE(overlap->equal);
    // A camera that saw the same wall is not a common recording.
    const Numbers wall(50, 0.25F);
    const auto with_wall = [&](unsigned seed) {
        return EpisodeContent{{"z", content_of(random_numbers(50, seed), true)},
                              {"w", content_of(wall, true)}};
    };
    EXPECT_FALSE(found(with_wall(1), with_wall(3)));
    EXPECT_TRUE(found(with_wall(1), with_wall(1))->equal);
}

/// An embedding beside a scalar.
EpisodeContent beside(const Numbers& z, const Numbers& x) {
    return {{"x", content_of(x, false)}, {"z", content_of(z, true)}};
}

Numbers clock_of(std::size_t steps) {
    Numbers times(steps);
    for (std::size_t t = 0; t < steps; ++t) times[t] = 0.1F * static_cast<float>(t);
    return times;
}

TEST(Overlap, AnEmbeddingIsTheSameWhateverTheScalars) {
    for (const std::size_t n : {3U, 12U, 60U, 3000U}) {
        const Numbers z = random_numbers(n, 1);
        const auto scalars = [&](unsigned seed) { return random_numbers(n, seed); };
        const auto equal = found(beside(z, scalars(2)), beside(z, scalars(3)));
        ASSERT_TRUE(equal) << n;
        EXPECT_TRUE(equal->equal) << n;
        const auto part = found(beside(z, scalars(2)), beside(piece(z, 0, n - 1), scalars(3)));
        ASSERT_TRUE(part) << n;
        EXPECT_FALSE(part->equal) << n;
        // Equal scalars do not make one recording of two embeddings.
        EXPECT_FALSE(found(beside(z, scalars(2)), beside(random_numbers(n, 4), scalars(2)))) << n;
        EXPECT_FALSE(found(beside(z, clock_of(n)), beside(random_numbers(n, 4), clock_of(n)))) << n;
    }
}

/// Stays at some of the samples of a world, one after the other.
Numbers walk(const Numbers& world, std::size_t stays, std::size_t longest, unsigned seed) {
    std::mt19937 random(seed);
    Numbers samples;
    std::size_t at = world.size();
    for (std::size_t i = 0; i < stays; ++i) {
        std::size_t next = random() % world.size();
        while (next == at) next = random() % world.size();
        at = next;
        samples.insert(samples.end(), 1 + random() % longest, world[at]);
    }
    return samples;
}

TEST(Overlap, AnEmbeddingThatStandsStillTellsByItsChanges) {
    for (std::size_t different = 5; different <= 12; ++different)
        for (unsigned seed = 0; seed < 20; ++seed) {
            const auto stood = [&](unsigned by, std::size_t longest) {
                return walk(random_numbers(different, 1000 * by + seed), different, longest, seed);
            };
            // Other recordings beside the same clock, of as many different samples or fewer.
            const Numbers a = stood(1, 20);
            const Numbers b = stood(2, 20);
            const Numbers c = walk(random_numbers(different - 2, seed + 7000), 9, 20, seed + 1);
            EXPECT_FALSE(found(beside(a, clock_of(a.size())), beside(b, clock_of(b.size()))));
            EXPECT_FALSE(found(beside(a, clock_of(a.size())), beside(c, clock_of(c.size()))));
            // A world of so few images: other recordings show all of them too.
            const Numbers world = random_numbers(different, 3000 + seed);
            const Numbers once = walk(world, 30, 9, seed);
            const Numbers again = walk(world, 30, 9, seed + 500);
            EXPECT_FALSE(
                found(beside(once, clock_of(once.size())), beside(again, clock_of(again.size()))))
                << different << ' ' << seed;
            // The same one, beside other scalars, whole and cut on both sides.
            const Numbers x = random_numbers(once.size(), 5);
            const auto equal = found(beside(once, clock_of(once.size())), beside(once, x));
            ASSERT_TRUE(equal);
            EXPECT_TRUE(equal->equal);
            const std::size_t rest = once.size() - 20;
            const auto part = found(beside(once, x), beside(piece(once, 7, rest), clock_of(rest)));
            ASSERT_TRUE(part) << different << ' ' << seed;
            EXPECT_FALSE(part->equal);
        }
}

TEST(Overlap, ASampleThatNeverChangesLeavesItToTheOthers) {
    const Numbers task(60, 0.5F);  // the embedding of an instruction
    const auto with_task = [&](const Numbers& x) { return beside(task, x); };
    const Numbers x = random_numbers(60, 1);
    EXPECT_FALSE(found(with_task(x), with_task(random_numbers(60, 2))));
    EXPECT_TRUE(found(with_task(x), with_task(x))->equal);
    EXPECT_TRUE(found(with_task(x), beside(piece(task, 0, 50), piece(x, 0, 50))));
    EXPECT_FALSE(found(with_task(x), beside(Numbers(60, 0.25F), x)));  // another instruction
}

TEST(Overlap, FilesOfEarlierVersionsDoNotSayWhatAnInputIs) {
    const Numbers z = random_numbers(60, 1);
    EpisodeContent earlier = beside(z, random_numbers(60, 2));
    for (auto& [name, content] : earlier) content.samples = Samples::runs;
    EXPECT_TRUE(found(earlier, beside(z, random_numbers(60, 3)))->equal);
    EXPECT_FALSE(found(earlier, beside(random_numbers(60, 4), random_numbers(60, 2))));
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
