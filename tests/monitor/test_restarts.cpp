// Tests the calls of a generated class for monitors that restart, one by one. test_generated
// compares every verdict with the definition.
#include <gtest/gtest.h>

#include "restarts.hpp"

namespace {

using restarts::Inputs;
using restarts::Monitor;
using restarts::Verdicts;

/// A step in which only `change` happens.
template <class Change>
Verdicts step(Monitor& monitor, Change change) {
    Inputs in;
    in.pick = false;
    in.place = false;
    in.open = false;
    in.near = 3.0F;
    change(in);
    return monitor.step(in);
}

Verdicts step(Monitor& monitor) {
    return step(monitor, [](Inputs&) {});
}

TEST(Restarts, ARepeatingMonitorCountsItsCycles) {
    Monitor monitor;
    EXPECT_TRUE(step(monitor, [](Inputs& in) { in.pick = true; }).cycle.open());
    EXPECT_TRUE(step(monitor, [](Inputs& in) { in.place = true; }).cycle.fulfilled());
    EXPECT_EQ(monitor.fulfilled_cycle(), 1U);
    // The next cycle has 6 steps to begin, and nothing is picked.
    for (int i = 0; i < 5; ++i) EXPECT_TRUE(step(monitor).cycle.open()) << i;
    EXPECT_TRUE(step(monitor).cycle.alarm());
    EXPECT_EQ(monitor.alarms_cycle(), 1U);
    // And so has the one after that.
    for (int i = 0; i < 5; ++i) EXPECT_TRUE(step(monitor).cycle.open()) << i;
    EXPECT_TRUE(step(monitor).cycle.alarm());
    EXPECT_EQ(monitor.alarms_cycle(), 2U);
    EXPECT_EQ(monitor.fulfilled_cycle(), 1U);
    monitor.reset();
    EXPECT_EQ(monitor.alarms_cycle(), 0U);
    EXPECT_EQ(monitor.fulfilled_cycle(), 0U);
}

TEST(Restarts, AProgramMayRestartARepeatingMonitorToo) {
    Monitor monitor;
    for (int i = 0; i < 5; ++i) step(monitor);
    monitor.restart_cycle();  // before the deadline
    for (int i = 0; i < 5; ++i) EXPECT_TRUE(step(monitor).cycle.open()) << i;
    EXPECT_TRUE(step(monitor).cycle.alarm());
    EXPECT_EQ(monitor.alarms_cycle(), 1U);
}

TEST(Restarts, AnAlarmStaysUntilItIsAcknowledged) {
    Monitor monitor;
    EXPECT_TRUE(step(monitor, [](Inputs& in) { in.open = true; }).shut.alarm());
    EXPECT_TRUE(step(monitor).shut.alarm());
    monitor.restart_shut();
    EXPECT_FALSE(step(monitor).shut.alarm());
    EXPECT_TRUE(step(monitor, [](Inputs& in) { in.open = true; }).shut.alarm());
}

TEST(Restarts, AnOutageIsOverWhereTheProgramSaysSo) {
    Monitor monitor;
    EXPECT_TRUE(step(monitor, [](Inputs& in) { in.open = etlmon::Flag(); }).shut.unknown());
    for (int i = 0; i < 10; ++i) EXPECT_TRUE(step(monitor).shut.unknown());
    monitor.restart_shut();
    EXPECT_TRUE(step(monitor).shut.satisfied());
}

TEST(Restarts, ThePastIsTheWholeTrace) {
    Monitor monitor;
    step(monitor, [](Inputs& in) { in.pick = true; });
    monitor.restart_knocked();
    EXPECT_TRUE(step(monitor, [](Inputs& in) { in.open = true; }).knocked.satisfied());
}

TEST(Restarts, OthersGoOn) {
    Monitor monitor;
    step(monitor, [](Inputs& in) { in.open = true; });
    monitor.restart_knocked();
    EXPECT_TRUE(step(monitor).shut.alarm());
}

/// Both verdicts are about this step.
template <class Verdict>
void expect_same(const Verdict& let, const Verdict& monitor, int at) {
    EXPECT_EQ(let.decided(), monitor.decided()) << at;
    EXPECT_EQ(let.satisfied(), monitor.satisfied()) << at;
    EXPECT_EQ(let.violated(), monitor.violated()) << at;
    EXPECT_EQ(let.unknown(), monitor.unknown()) << at;
}

/// With samples missing, whatever restarts, and until the end of the trace.
TEST(Lets, SayOfEachStepWhatASlidingMonitorSaysOfIt) {
    Monitor monitor;
    EXPECT_FALSE(monitor.let_calm().decided());
    int unknown = 0;
    Verdicts last;
    for (int i = 0; i < 60; ++i) {
        if (i % 7 == 3) monitor.restart_shut();
        if (i == 30) monitor.reset();
        last = step(monitor, [&](Inputs& in) {
            in.open = i % 5 == 1;
            in.near = i % 4 == 1 ? 0.5F : 2.0F;
            if (i % 11 == 6) in.open = etlmon::Flag();
            in.pick = i == 50;
        });
        expect_same(monitor.let_calm(), last.calm_now, i);
        unknown += monitor.let_calm().unknown() ? 1 : 0;
    }
    EXPECT_GT(unknown, 3);
    monitor.finish();
    expect_same(monitor.let_calm(), last.calm_now, 60);
    monitor.reset();
    EXPECT_FALSE(monitor.let_calm().decided());
}

TEST(Missing, CountsAsTheSpecSays) {
    Monitor monitor;
    const Verdicts verdicts = step(monitor, [](Inputs& in) { in.near = etlmon::kMissing; });
    EXPECT_TRUE(verdicts.safe.alarm());
    EXPECT_TRUE(verdicts.now.violated());
    EXPECT_EQ(monitor.missing_steps(), 1U);
    EXPECT_FALSE(step(monitor).now.violated());
    // A sample may be missing at any later step, so nothing is decided early.
    EXPECT_TRUE(Monitor().step(Inputs()).safe.alarm());
}

}  // namespace
