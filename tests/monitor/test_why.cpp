// What a class says that was made with --explain: the calls of a generated class, one by one. That
// every sample is the one that `etlc explain` names is shown by the campaign.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "adapting.hpp"
#include "why.hpp"

namespace {

using why::Inputs;
using why::Monitor;
using why::Verdicts;

/// Far from all people, slow, the door open; but for what `change` says.
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
        step(monitor);  // it stays the one, however long ago
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
    EXPECT_EQ(monitor.why_careful().step, 1U);  // the least that was missing
    EXPECT_EQ(monitor.why_careful().distance, 1.125F);
}

TEST(Why, AnOpenVerdictHasTheSampleOfItsRobustness) {
    Monitor monitor;
    const float speeds[] = {3.0F, 0.625F, 2.0F, 0.625F, 1.0F};
    for (const float speed : speeds)
        EXPECT_TRUE(step(monitor, [&](Inputs& in, float*) { in.speed = speed; }).stops.open());
    const etlmon::Sample why = monitor.why_stops();
    EXPECT_EQ(std::string(why.predicate), "speed <= 0.5");  // a comparison without a name
    EXPECT_EQ(why.step, 3U);  // of two that fail alike the earlier counts as farther from 0
    EXPECT_EQ(why.distance, 0.625F);
    EXPECT_EQ(why.threshold, 0.5F);
    EXPECT_EQ(why.row, etlmon::kNoRow);  // nothing is nearest to a speed
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

TEST(Why, AnAdaptiveThresholdIsTheOneOfThatStep) {
    adaptive::Monitor monitor;
    adaptive::Inputs in;
    in.x = 1.125F;
    monitor.step(in);
    const float then = monitor.threshold_low();
    monitor.observe_low(1.125F, true);
    ASSERT_NE(monitor.threshold_low(), then);
    in.x = 4.0F;
    monitor.step(in);
    EXPECT_EQ(std::string(monitor.why_both().predicate), "low");
    EXPECT_EQ(monitor.why_both().step, 0U);
    EXPECT_EQ(monitor.why_both().threshold, then);
}

/// One predicate, of which one step and one value are remembered.
using Samples = etlmon::Samples<etlmon::SeenNumber, 1, 1, 1, 1>;
constexpr etlmon::Place kPlaces[] = {{"p", 0.5F}};

void take(Samples& samples, std::uint32_t at, const etlmon::Verdict& verdict) {
    const etlmon::SeenNumber seen[] = {{2.0F}};
    samples.step(at, seen);
    const etlmon::Sourced value =
        etlmon::sourced(etlmon::known(-1.5F), etlmon::Ranks<1>::first(at));
    samples.answer(0, value, verdict);
}

TEST(Why, BeyondTheLastStepThatIsCountedASampleHasNone) {
    const etlmon::Verdict violated = etlmon::sliding_verdict(etlmon::known(-1.5F));
    Samples samples;
    samples.reset();
    take(samples, etlmon::Ranks<1>::kLastStep - 1, violated);
    EXPECT_EQ(samples.sample(0, kPlaces).step, etlmon::Ranks<1>::kLastStep - 1);
    EXPECT_EQ(samples.sample(0, kPlaces).distance, 2.0F);
    for (const std::uint32_t late : {etlmon::Ranks<1>::kLastStep, UINT32_MAX}) {
        take(samples, late, violated);
        EXPECT_EQ(std::string(samples.sample(0, kPlaces).predicate), "p");
        EXPECT_EQ(samples.sample(0, kPlaces).step, UINT32_MAX);
        EXPECT_TRUE(std::isnan(samples.sample(0, kPlaces).distance));
    }
}

TEST(Why, ASampleThatNothingHoldsIsForgottenButForItsStep) {
    const etlmon::Verdict violated = etlmon::sliding_verdict(etlmon::known(-1.5F));
    const etlmon::SeenNumber later[] = {{3.0F}};
    Samples samples;
    samples.reset();
    take(samples, 0, violated);
    samples.step(1, later);
    EXPECT_EQ(samples.sample(0, kPlaces).step, 0U);
    EXPECT_TRUE(std::isnan(samples.sample(0, kPlaces).distance));
}

}  // namespace
