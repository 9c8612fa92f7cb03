// Tests the measurements of a Boolean class through its telemetry: NaN means "not measured" if the
// sample was present.
#include <gtest/gtest.h>

#include "demand.hpp"

namespace {

constexpr float kOrigin[2] = {0, 0};
constexpr float kBetween[2] = {5, 5};
constexpr float kFar[2] = {10, 10};

bool measured(float distance) {
    return !etlmon::is_nan(distance);
}

/// z and y are present at every step; armed as given.
demand::Inputs see(const float (&z)[2], const float (&y)[2], bool armed = false) {
    demand::Inputs in;
    in.z = z;
    in.y = y;
    in.armed = armed;
    return in;
}

// F (a && F b): a until a holds, from that step on only b, nothing once the verdict is final.
TEST(Demand, OneAfterTheOther) {
    demand::Monitor monitor;
    monitor.step(see(kFar, kBetween));
    EXPECT_TRUE(measured(monitor.distance_a()));
    EXPECT_FALSE(measured(monitor.distance_b()));
    monitor.step(see(kOrigin, kBetween));
    EXPECT_TRUE(measured(monitor.distance_a()));
    EXPECT_TRUE(measured(monitor.distance_b()));  // b at the same position counts
    monitor.step(see(kOrigin, kBetween));
    EXPECT_FALSE(measured(monitor.distance_a()));
    EXPECT_TRUE(measured(monitor.distance_b()));
    const demand::Verdicts done = monitor.step(see(kFar, kBetween));
    EXPECT_TRUE(done.in_order.satisfied());
    EXPECT_TRUE(done.in_order.final());
    EXPECT_EQ(monitor.nearest_b(), 0U);
    monitor.step(see(kOrigin, kBetween));
    EXPECT_FALSE(measured(monitor.distance_a()));
    EXPECT_FALSE(measured(monitor.distance_b()));
}

// G (armed && c -> F[0,2] d): nothing while not armed, c while no answer is due, only d while one
// is.
TEST(Demand, OnlyWhatIsDue) {
    demand::Monitor monitor;
    monitor.step(see(kFar, kOrigin, false));
    EXPECT_FALSE(measured(monitor.distance_c()));
    EXPECT_FALSE(measured(monitor.distance_d()));
    monitor.step(see(kFar, kBetween, true));
    EXPECT_TRUE(measured(monitor.distance_c()));
    EXPECT_FALSE(measured(monitor.distance_d()));
    EXPECT_TRUE(monitor.step(see(kFar, kOrigin, true))
                    .answered.violated());  // measured; no answer on this prefix
    EXPECT_TRUE(measured(monitor.distance_c()));
    EXPECT_TRUE(measured(monitor.distance_d()));
    monitor.step(see(kFar, kOrigin, true));
    EXPECT_FALSE(measured(monitor.distance_c()));
    EXPECT_TRUE(measured(monitor.distance_d()));
    EXPECT_FALSE(monitor.step(see(kFar, kFar, true)).answered.violated());
    EXPECT_FALSE(monitor.step(see(kFar, kOrigin, true)).answered.final());
    EXPECT_FALSE(monitor.step(see(kFar, kBetween, true)).answered.final());
    EXPECT_TRUE(monitor.step(see(kFar, kBetween, true)).answered.final());  // too late
    EXPECT_TRUE(monitor.step(see(kFar, kFar, true)).answered.violated());
    EXPECT_FALSE(measured(monitor.distance_d()));
}

// A missing sample counts if it was needed.
TEST(Demand, MissingStepsAreThoseThatMattered) {
    demand::Monitor monitor;
    demand::Inputs in = see(kOrigin, kBetween);
    monitor.step(in);
    EXPECT_EQ(monitor.missing_steps(), 0U);
    in.y = etlmon::Vector<float, 2>();
    monitor.step(in);  // not armed: y changes nothing
    EXPECT_EQ(monitor.missing_steps(), 0U);
    in.z = etlmon::Vector<float, 2>();
    monitor.step(in);
    EXPECT_EQ(monitor.missing_steps(), 1U);
}

}  // namespace
