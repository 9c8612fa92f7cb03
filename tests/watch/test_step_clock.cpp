// The steps of frames that come at given times, against the definition: a step for each 1 / rate
// seconds of real time.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "watch/camera.hpp"

namespace etlc::watch {

namespace {

using std::chrono::duration;
using std::chrono::duration_cast;

constexpr double kStep = 1.0 / 30;

StepClock::Time at(double seconds) {
    return StepClock::Time(
        duration_cast<StepClock::Time::duration>(duration<double>(1000 + seconds)));
}

/// Returns the step of each frame, -1 for one that has none.
std::vector<std::int64_t> steps_of(const std::vector<double>& frames, double step = kStep) {
    StepClock clock(step);
    std::vector<std::int64_t> steps;
    std::int64_t next = -1;
    for (const double frame : frames) {
        const auto passed = static_cast<std::int64_t>(clock.take(at(frame)));
        next += passed;
        steps.push_back(passed == 0 ? -1 : next);
    }
    return steps;
}

std::vector<double> regular(double rate, std::size_t count, double jitter = 0) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> shift(-jitter, jitter);
    std::vector<double> frames;
    for (std::size_t i = 0; i < count; ++i)
        frames.push_back(static_cast<double>(i) / rate + (i == 0 ? 0 : shift(random)));
    return frames;
}

TEST(StepClock, EachFrameOfACameraAtTheRateIsAStep) {
    for (const double jitter : {0.0, 0.005, 0.012}) {
        const auto steps = steps_of(regular(30, 3000, jitter));
        for (std::size_t i = 0; i < steps.size(); ++i)
            ASSERT_EQ(steps[i], static_cast<std::int64_t>(i)) << "jitter " << jitter;
    }
}

TEST(StepClock, FollowsACameraWhoseClockDiffersALittle) {
    for (const double rate : {29.97, 29.87, 30.13}) {
        const auto steps = steps_of(regular(rate, 20000, 0.003));
        for (std::size_t i = 0; i < steps.size(); ++i)
            ASSERT_EQ(steps[i], static_cast<std::int64_t>(i)) << rate;
    }
}

TEST(StepClock, ACameraOfAnotherRateKeepsTheTime) {
    for (const double rate : {5.0, 12.0, 25.0, 29.0, 29.7, 30.3, 31.0, 50.0, 60.0, 144.0}) {
        const auto frames = regular(rate, 3000, 0.1 / rate);
        const auto steps = steps_of(frames);
        std::int64_t taken = 0;
        std::int64_t last = -1;
        for (std::size_t i = 0; i < steps.size(); ++i) {
            if (steps[i] < 0) continue;
            ++taken;
            ASSERT_GT(steps[i], last);
            last = steps[i];
            const double place = frames[i] / kStep;
            ASSERT_NEAR(static_cast<double>(steps[i]), place, 1.3) << rate << ", frame " << i;
        }
        const double wanted = std::min(rate, 30.0) / rate * 3000;
        EXPECT_NEAR(static_cast<double>(taken), wanted, 0.02 * wanted) << rate;
    }
}

TEST(StepClock, AWholeMultipleOfTheRateTakesEveryNthFrame) {
    const auto steps = steps_of(regular(90, 9000, 0.002));
    std::int64_t next = 0;
    for (std::size_t i = 0; i < steps.size(); i += 3) ASSERT_EQ(steps[i], next++) << i;
}

TEST(StepClock, StepsWithoutFramesAreNotShifted) {
    std::mt19937 random(3);
    std::bernoulli_distribution is_lost(0.3);
    std::vector<double> frames;
    std::vector<std::int64_t> expected;
    for (std::int64_t i = 0; i < 3000; ++i) {
        if (i > 0 && (is_lost(random) || (i > 500 && i < 900))) continue;
        frames.push_back(static_cast<double>(i) * kStep);
        expected.push_back(i);
    }
    EXPECT_EQ(steps_of(frames), expected);
}

TEST(StepClock, StepsGoOnWhileNoFrameComes) {
    StepClock clock(kStep);
    EXPECT_EQ(clock.overdue(at(5)), 0U);  // before the first frame there is no step
    EXPECT_FALSE(clock.next_overdue());
    EXPECT_EQ(clock.take(at(0)), 1U);
    EXPECT_EQ(clock.overdue(at(2.4 * kStep)), 0U);  // a frame of step 1 may be on its way
    EXPECT_EQ(clock.overdue(at(2.6 * kStep)), 1U);
    EXPECT_EQ(clock.take(at(1.1 * kStep)), 0U);  // too late for its step
    EXPECT_EQ(clock.overdue(at(10.6 * kStep)), 8U);
    EXPECT_EQ(clock.take(at(10.9 * kStep)), 2U);  // step 11: 10 had no frame
    ASSERT_TRUE(clock.next_overdue());
    EXPECT_GT(*clock.next_overdue(), at(13 * kStep));
}

/// Who waits for the time at which a step is overdue need not wait again.
TEST(StepClock, AStepIsOverdueWhenItSays) {
    for (const double rate : {1.0, 7.0, 24.0, 29.97, 30.0, 60.0, 144.0, 1000.0}) {
        StepClock clock(1 / rate);
        for (int frame = 0; frame < 200; ++frame) {
            clock.take(at(frame / rate * 1.3));
            StepClock later = clock;
            EXPECT_GE(later.overdue(*clock.next_overdue()), 1U) << rate << ", frame " << frame;
        }
    }
}

TEST(StepClock, WithoutARateEveryFrameIsAStep) {
    StepClock clock(0);
    for (const double frame : {0.0, 0.0, 0.1, 7.0, 7.001}) {
        EXPECT_EQ(clock.take(at(frame)), 1U);
        EXPECT_EQ(clock.overdue(at(frame + 100)), 0U);
    }
    EXPECT_FALSE(clock.next_overdue());
}

}  // namespace

}  // namespace etlc::watch
