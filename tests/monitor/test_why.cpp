// Tests the calls of a generated class made with --explain, one by one. The campaign compares every
// sample with `etlc explain`.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "adapting.hpp"
#include "why.hpp"

namespace {

using why::Inputs;
using why::Monitor;
using why::Verdicts;

/// Far from all people, slow, the door open; except for `change`.
template <class Change>
Verdicts step(Monitor& monitor, Change change) {
    float z[2] = {-4.0F, -4.0F};
    Inputs in;
    in.z = z;
    in.speed = 0.75F;
    in.shut = false;
    change(in, z);
    return monitor.step(in);
}

Verdicts step(Monitor& monitor) {
    return step(monitor, [](Inputs&, float*) {});
}

/// In front of the second of the people.
void meet(Inputs&, float* z) {
    z[0] = 0.25F;
    z[1] = 1.0F;
}

TEST(Why, AnAlarmNamesTheNearestTarget) {
    Monitor monitor;
    step(monitor);
    EXPECT_TRUE(step(monitor, meet).apart.alarm());
    for (int later = 0; later < 100; ++later) {
        const etlmon::Sample why = monitor.why_apart();
        ASSERT_TRUE(why);
        EXPECT_EQ(std::string(why.predicate), "near");
        EXPECT_EQ(why.step, 1U);
        EXPECT_EQ(why.distance, 0.25F);
        EXPECT_EQ(why.threshold, 0.5F);
        EXPECT_EQ(why.row, 1U);
        step(monitor);  // it stays the sample, however old
    }
}

TEST(Why, AResponseThatFailsIsFollowedToTheSampleThatDecides) {
    Monitor monitor;
    const auto drive = [](float speed) {
        return [speed](Inputs& in, float*) { in.speed = speed; };
    };
    step(monitor, [](Inputs& in, float* z) { meet(in, z), in.speed = 3.0F; });
    step(monitor, drive(1.125F));
    EXPECT_TRUE(step(monitor, drive(2.0F)).careful.alarm());
    EXPECT_EQ(std::string(monitor.why_careful().predicate), "is_slow");
    EXPECT_EQ(monitor.why_careful().step, 1U);  // the worst missing one
    EXPECT_EQ(monitor.why_careful().distance, 1.125F);
}

TEST(Why, AnOpenVerdictHasTheSampleOfItsRobustness) {
    Monitor monitor;
    const float speeds[] = {3.0F, 0.625F, 2.0F, 0.625F, 1.0F};
    for (const float speed : speeds)
        EXPECT_TRUE(step(monitor, [&](Inputs& in, float*) { in.speed = speed; }).stops.open());
    const etlmon::Sample why = monitor.why_stops();
    EXPECT_EQ(std::string(why.predicate), "speed <= 0.5");  // an unnamed comparison
    EXPECT_EQ(why.step, 3U);  // of two equal failures the earlier counts as farther from 0
    EXPECT_EQ(why.distance, 0.625F);
    EXPECT_EQ(why.threshold, 0.5F);
    EXPECT_EQ(why.row, etlmon::kNoRow);  // a speed has no nearest row
}

TEST(Why, OfEqualAlarmsTheFirstDecides) {
    Monitor monitor;
    step(monitor, meet);
    step(monitor, meet);
    EXPECT_EQ(monitor.why_apart().step, 0U);
}

TEST(Why, ABoolHasNoThreshold) {
    Monitor monitor;
    step(monitor);
    EXPECT_TRUE(step(monitor, [](Inputs& in, float*) { in.shut = true; }).door.fulfilled());
    EXPECT_EQ(std::string(monitor.why_door().predicate), "shut");
    EXPECT_EQ(monitor.why_door().step, 1U);
    EXPECT_EQ(monitor.why_door().distance, 1.0F);
    EXPECT_TRUE(std::isnan(monitor.why_door().threshold));
}

TEST(Why, StepsAreThoseOfTheEpisodeAfterARestartToo) {
    Monitor monitor;
    step(monitor, [](Inputs& in, float*) { in.shut = true; });
    monitor.restart_door();
    EXPECT_EQ(monitor.why_door().step, 0U);  // until the next verdict
    EXPECT_TRUE(step(monitor).door.open());
    EXPECT_EQ(monitor.why_door().step, 1U);
    EXPECT_EQ(monitor.why_door().distance, 0.0F);
    monitor.reset();
    EXPECT_FALSE(monitor.why_door());
    step(monitor);
    EXPECT_EQ(monitor.why_door().step, 0U);
}

TEST(Why, ASlidingMonitorSaysItOfEachStep) {
    Monitor monitor;
    EXPECT_TRUE(step(monitor).calm.satisfied());
    EXPECT_EQ(std::string(monitor.why_calm().predicate), "is_slow");
    step(monitor, [](Inputs& in, float*) { in.speed = 9.0F; });
    EXPECT_EQ(std::string(monitor.why_calm().predicate), "is_slow");  // the worse of the two
    EXPECT_EQ(monitor.why_calm().step, 1U);
    EXPECT_EQ(monitor.why_calm().distance, 9.0F);
}

TEST(Why, AnUnknownVerdictHasNone) {
    Monitor monitor;
    EXPECT_FALSE(monitor.why_calm());
    const Verdicts verdicts =
        step(monitor, [](Inputs& in, float*) { in.speed = etlmon::kMissing; });
    EXPECT_TRUE(verdicts.calm.unknown());
    EXPECT_FALSE(monitor.why_calm());
}

TEST(Why, OfAnAdaptivePredicateTheRobustnessIsKnown) {
    adaptive::Monitor monitor;
    adaptive::Inputs in;
    in.x = 1.125F;
    const float then = monitor.threshold_low();
    monitor.step(in);
    monitor.observe_low(1.125F, true);
    ASSERT_NE(monitor.threshold_low(), then);
    in.x = 4.0F;
    monitor.step(in);
    const etlmon::Sample why = monitor.why_both();
    EXPECT_EQ(std::string(why.predicate), "low");
    EXPECT_EQ(why.step, 0U);
    EXPECT_EQ(why.robustness, then - 1.125F);
    EXPECT_TRUE(std::isnan(why.threshold));
    EXPECT_TRUE(std::isnan(why.distance));
}

/// Two predicates: one with three rows, and one without rows.
constexpr etlmon::Place kPlaces[] = {{"near", etlmon::Place::Kind::at_most, 0.5F, 0, 3},
                                     {"fast", etlmon::Place::Kind::at_least, 2.0F, 4, 0}};
constexpr std::uint32_t kCodes = 6;
using Order = etlmon::Ranks<kCodes>;

etlmon::SourcedKey key(float robustness, std::uint32_t step, std::uint32_t code) {
    return etlmon::sourced(etlmon::between(robustness, robustness), Order::first(step) - code).low;
}

TEST(Why, AValueSaysItsSampleHoweverOftenItIsNegated) {
    const std::uint32_t near = etlmon::code_of(0, 0.75F, 2, 3), fast = etlmon::code_of(4, 3.0F);
    for (const float robustness : {-0.25F, 0.0F, 0.125F}) {
        for (etlmon::SourcedKey value :
             {key(robustness, 7, near), etlmon::negate(key(robustness, 7, near))}) {
            const etlmon::Sample why = etlmon::sample_of<kCodes>(value, kPlaces);
            EXPECT_EQ(std::string(why.predicate), "near");
            EXPECT_EQ(why.step, 7U);
            EXPECT_EQ(why.row, 2U);
            EXPECT_EQ(why.robustness, robustness);
            EXPECT_EQ(why.distance, 0.5F - robustness);
        }
    }
    const auto why = etlmon::sample_of<kCodes>(etlmon::negate(key(1.0F, 0, fast)), kPlaces);
    EXPECT_EQ(std::string(why.predicate), "fast");
    EXPECT_EQ(why.distance, 3.0F);
    EXPECT_EQ(why.row, etlmon::kNoRow);
}

/// A verdict is satisfied by low ends, which are measured from the inner threshold, and violated by
/// high ones; a negation exchanges them.
TEST(Why, OfTwoThresholdsTheOneThatDecides) {
    constexpr etlmon::Place kTwo[] = {{"near", etlmon::Place::Kind::at_most, 0.5F, 0, 3, 0.25F},
                                      {"fast", etlmon::Place::Kind::at_least, 2.0F, 4, 0, 3.0F}};
    const std::uint32_t near = etlmon::code_of(0, 0.75F, 2, 3), fast = etlmon::code_of(4, 3.0F);
    const auto expect = [&](etlmon::SourcedKey value, float threshold, float distance,
                            float least = 0.0F) {
        const auto why = etlmon::sample_of<kCodes>(value, kTwo, etlmon::key_of(least));
        EXPECT_EQ(why.threshold, threshold);
        EXPECT_EQ(why.distance, distance);
    };
    expect(key(0.125F, 7, near), 0.25F, 0.125F);
    expect(key(-0.25F, 7, near), 0.5F, 0.75F);
    expect(etlmon::negate(key(-0.25F, 7, near)), 0.5F, 0.75F);
    expect(etlmon::negate(key(0.125F, 7, near)), 0.25F, 0.125F);
    expect(key(0.0F, 7, near), 0.25F, 0.25F);
    expect(etlmon::negate(key(0.0F, 7, near)), 0.5F, 0.5F);
    expect(key(1.0F, 7, fast), 3.0F, 4.0F);
    expect(key(-1.0F, 7, fast), 2.0F, 1.0F);
    // A monitor that is calibrated as a whole may be satisfied below 0.
    expect(key(-0.25F, 7, near), 0.25F, 0.5F, -0.5F);
}

TEST(Why, OfASampleThatWasMissingNothingWasMeasured) {
    const float missing = etlmon::kMissing;
    for (const std::uint32_t code :
         {etlmon::code_of(0, missing, 0, 3), etlmon::code_of(4, missing)}) {
        const auto why = etlmon::sample_of<kCodes>(key(-1.0F, 2, code), kPlaces);
        EXPECT_EQ(why.step, 2U);
        EXPECT_TRUE(std::isnan(why.distance));
        EXPECT_TRUE(std::isnan(why.robustness));
        EXPECT_EQ(why.row, etlmon::kNoRow);
    }
}

TEST(Why, EarlierSamplesAreFartherFromZero) {
    const std::uint32_t last = 2 * (kCodes - 1);
    for (const std::uint32_t step : {0U, 1U, 1000U, Order::kLastStep - 1}) {
        EXPECT_GT(key(1.0F, step, last).order, key(1.0F, step + 1, 0).order);
        EXPECT_GT(key(1.0F, step, 0).order, key(1.0F, step, last).order);
        EXPECT_LT(key(-1.0F, step, last).order, key(-1.0F, step + 1, 0).order);
        EXPECT_LT(key(-1.0F, step, 0).order, key(-1.0F, step, last).order);
        EXPECT_GT(key(0.0F, step, 0).order, etlmon::negate(key(0.0F, step, 0)).order);
    }
    EXPECT_GT(key(1.0F, Order::kLastStep, last).order,
              etlmon::SourcedKey(etlmon::key_of(1.0F)).order);
    EXPECT_LT(key(-1.0F, Order::kLastStep, last).order,
              etlmon::SourcedKey(etlmon::key_of(-1.0F)).order);
}

TEST(Why, BeyondTheLastStepThatIsCountedASampleHasNone) {
    const auto step_of = [](std::uint32_t step) {
        return etlmon::sample_of<kCodes>(key(-1.5F, step, 8), kPlaces).step;
    };
    EXPECT_EQ(step_of(Order::kLastStep - 1), Order::kLastStep - 1);
    EXPECT_EQ(step_of(Order::kLastStep), UINT32_MAX);
    EXPECT_EQ(step_of(UINT32_MAX), UINT32_MAX);
    EXPECT_EQ(std::string(etlmon::sample_of<kCodes>(key(-1.5F, UINT32_MAX, 8), kPlaces).predicate),
              "fast");
}

}  // namespace
