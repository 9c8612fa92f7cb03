// Tests the results of each function of etlc.h.
#include <etlc.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "opened.hpp"

namespace etlc::tests {
namespace {

TEST(Interface, DescribesTheSpec) {
    const Opened dock(options_of(kDock));
    etlc_description spec{};
    spec.struct_size = sizeof spec;
    ASSERT_EQ(etlc_describe(dock, &spec), ETLC_OK);
    EXPECT_STREQ(spec.name, "dock");
    EXPECT_EQ(spec.inputs, 6U);
    EXPECT_EQ(spec.monitors, 3U);
    EXPECT_EQ(spec.predicates, 3U);
    EXPECT_EQ(spec.lets, 0U);
    EXPECT_EQ(spec.horizon, 2U);
    EXPECT_EQ(spec.step_seconds, 0.1);
    EXPECT_GT(spec.state_bytes, 0U);
    EXPECT_NE(spec.spec_hash, 0U);
    EXPECT_NE(std::string(spec.warnings).find("unread"), std::string::npos) << spec.warnings;
}

TEST(Interface, HasTheWarningsOfWhatItOpens) {
    const etlc_options options = options_of(kDock);
    etlc_session session = 0;
    ASSERT_EQ(etlc_open(&options, &session), ETLC_OK);
    EXPECT_STREQ(etlc_message(), "");
    EXPECT_NE(std::string(etlc_message_json()).find("\"code\": \"W0201\""), std::string::npos)
        << etlc_message_json();
    EXPECT_EQ(etlc_close(session), ETLC_OK);
    EXPECT_STREQ(etlc_message_json(), "{\"diagnostics\": []}\n");
}

TEST(Interface, DescribesInputs) {
    const Opened dock(options_of(kDock));
    const struct {
        const char* name;
        std::uint32_t type, dimension, hold, is_used;
        float low, high, scale;
    } expected[] = {{"z", ETLC_F32, 3, 1, 1, -INFINITY, INFINITY, 1},
                    {"charge", ETLC_F32, 1, 0, 1, 0, 1, 1},
                    {"stop", ETLC_BOOL, 1, 0, 1, -INFINITY, INFINITY, 1},
                    {"half", ETLC_F16, 2, 0, 1, -INFINITY, INFINITY, 1},
                    {"byte", ETLC_I8, 2, 0, 1, -INFINITY, INFINITY, 0.5F},
                    {"unread", ETLC_F32, 1, 0, 0, -INFINITY, INFINITY, 1}};
    for (std::uint32_t i = 0; i < 6; ++i) {
        etlc_input input{};
        input.struct_size = sizeof input;
        ASSERT_EQ(etlc_describe_input(dock, i, &input), ETLC_OK);
        EXPECT_STREQ(input.name, expected[i].name);
        EXPECT_EQ(input.type, expected[i].type) << input.name;
        EXPECT_EQ(input.dimension, expected[i].dimension) << input.name;
        EXPECT_EQ(input.hold, expected[i].hold) << input.name;
        EXPECT_EQ(input.is_used, expected[i].is_used) << input.name;
        EXPECT_EQ(input.is_embedding, input.dimension > 1 ? 1U : 0U) << input.name;
        EXPECT_EQ(input.low, expected[i].low) << input.name;
        EXPECT_EQ(input.high, expected[i].high) << input.name;
        EXPECT_EQ(input.scale, expected[i].scale) << input.name;
        std::uint32_t found = 99;
        EXPECT_EQ(etlc_find(dock, ETLC_INPUTS, input.name, &found), ETLC_OK);
        EXPECT_EQ(found, i);
    }
}

TEST(Interface, DescribesMonitorsPredicatesAndLets) {
    etlc_options options = options_of(kDock);
    options.lets = 1;
    const Opened dock(options);
    etlc_monitor monitor{};
    monitor.struct_size = sizeof monitor;
    ASSERT_EQ(etlc_describe_monitor(dock, 1, &monitor), ETLC_OK);
    EXPECT_STREQ(monitor.name, "visits");
    EXPECT_STREQ(monitor.formula, "F (at_bay && !stop)");
    EXPECT_EQ(monitor.restarts, std::uint32_t{ETLC_ON_REQUEST});
    EXPECT_EQ(monitor.is_sliding, 0U);
    ASSERT_EQ(etlc_describe_monitor(dock, 2, &monitor), ETLC_OK);
    EXPECT_EQ(monitor.is_sliding, 1U);
    EXPECT_EQ(monitor.horizon, 2U);
    etlc_predicate predicate{};
    predicate.struct_size = sizeof predicate;
    ASSERT_EQ(etlc_describe_predicate(dock, 0, &predicate), ETLC_OK);
    EXPECT_STREQ(predicate.name, "at_bay");
    EXPECT_STREQ(predicate.text, "min l2(z, bay) <= 0.5");
    EXPECT_EQ(predicate.is_measured, 1U);
    EXPECT_EQ(predicate.is_adaptive, 0U);
    EXPECT_EQ(predicate.has_nearest, 1U);
    const char* let = nullptr;
    ASSERT_EQ(etlc_describe_let(dock, 0, &let), ETLC_OK);
    EXPECT_STREQ(let, "docked");
    std::uint32_t index = 99;
    EXPECT_EQ(etlc_find(dock, ETLC_MONITORS, "calm", &index), ETLC_OK);
    EXPECT_EQ(index, 2U);
    EXPECT_EQ(etlc_find(dock, ETLC_PREDICATES, "is_low", &index), ETLC_OK);
    EXPECT_EQ(index, 1U);
    EXPECT_EQ(etlc_find(dock, ETLC_LETS, "docked", &index), ETLC_OK);
    EXPECT_EQ(index, 0U);
}

TEST(Interface, StepsAndSaysWhatItMeasured) {
    etlc_options options = options_of(kDock);
    options.lets = 1;
    Opened dock(options);
    Seen seen;
    seen.z[0] = 0.75F;
    ASSERT_EQ(dock.step(seen.samples()), ETLC_OK) << etlc_message();
    EXPECT_EQ(dock.verdicts[1].robustness, 0.25F);
    EXPECT_EQ(dock.verdicts[1].status, std::uint32_t{ETLC_SATISFIED | ETLC_DECIDED | ETLC_FINAL});
    EXPECT_EQ(dock.verdicts[2].status, 0U);
    EXPECT_TRUE(std::isnan(dock.verdicts[2].robustness));
    etlc_measured measured{};
    ASSERT_EQ(etlc_measure(dock, 0, &measured), ETLC_OK);
    EXPECT_EQ(measured.distance, 0.25F);
    EXPECT_EQ(measured.threshold, 0.5F);
    EXPECT_EQ(measured.nearest, 0U);
    ASSERT_EQ(etlc_measure(dock, 2, &measured), ETLC_OK);
    EXPECT_EQ(measured.distance, 3.0F);  // 1 of the half, 1 + 1 of the bytes
    etlc_verdict let{};
    ASSERT_EQ(etlc_let(dock, 0, &let), ETLC_OK);
    EXPECT_EQ(let.robustness, 0.25F);
    std::uint64_t steps = 0;
    ASSERT_EQ(etlc_steps(dock, &steps), ETLC_OK);
    EXPECT_EQ(steps, 1U);
    std::uint64_t position = 9;
    ASSERT_EQ(etlc_position(dock, 1, &position), ETLC_OK);
    EXPECT_EQ(position, 0U);
}

TEST(Interface, WhatIsNotFiniteOrNotThereCountsAsMissing) {
    Opened dock(options_of(kDock));
    Seen seen;
    seen.z[1] = NAN;
    seen.charge = 2;
    std::vector<etlc_sample> samples = seen.samples();
    samples[2].data = nullptr;
    ASSERT_EQ(dock.step(samples), ETLC_OK) << etlc_message();
    EXPECT_EQ(dock.verdicts[0].status & (ETLC_SATISFIED | ETLC_VIOLATED), 0U);
    etlc_counts counts{};
    ASSERT_EQ(etlc_count(dock, 0, &counts), ETLC_OK);
    EXPECT_EQ(counts.missing, 1U);
    EXPECT_EQ(counts.held, 0U);
    ASSERT_EQ(etlc_count(dock, 1, &counts), ETLC_OK);
    EXPECT_EQ(counts.out_of_range, 1U);
    ASSERT_EQ(etlc_count(dock, 2, &counts), ETLC_OK);
    EXPECT_EQ(counts.missing, 1U);
}

TEST(Interface, EveryKindOfNotFiniteCountsAsMissing) {
    Opened dock(options_of(kDock));
    int missing = 0;
    for (const float x : {NAN, -NAN, INFINITY, -INFINITY}) {
        Seen seen;
        seen.z[2] = x;
        seen.charge = x;
        for (const int half : {0x7e00, 0xfe00, 0x7c00, 0xfc00}) {
            seen.half[1] = static_cast<std::uint16_t>(half);
            ASSERT_EQ(dock.step(seen.samples()), ETLC_OK) << etlc_message();
            ++missing;
        }
    }
    for (const std::uint32_t input : {0U, 1U, 3U}) {
        etlc_counts counts{};
        ASSERT_EQ(etlc_count(dock, input, &counts), ETLC_OK);
        EXPECT_EQ(counts.missing, static_cast<std::uint64_t>(missing)) << input;
    }
    float rows[2][3] = {{1, 0, NAN}, {1, 0, 0}};
    etlc_column columns[6] = {};
    columns[0] = {rows, nullptr, sizeof rows[0], 3, ETLC_F32};
    std::vector<etlc_verdict> verdicts(6);
    ASSERT_EQ(etlc_reset(dock), ETLC_OK);
    ASSERT_EQ(etlc_run(dock, columns, 6, 2, verdicts.data(), 6), ETLC_OK);
    etlc_counts counts{};
    ASSERT_EQ(etlc_count(dock, 0, &counts), ETLC_OK);
    EXPECT_EQ(counts.missing, 1U);
}

TEST(Interface, StaleSamplesCountAsMissing) {
    Opened frozen(
        options_of("spec frozen; input x : f32 hold 1, stale after 2; monitor m = G x > 0;"));
    etlc_input input{};
    input.struct_size = sizeof input;
    ASSERT_EQ(etlc_describe_input(frozen, 0, &input), ETLC_OK);
    EXPECT_EQ(input.hold, 1U);
    EXPECT_EQ(input.stale_after, 2U);
    const float x = 1;
    for (int step = 0; step < 5; ++step)
        ASSERT_EQ(frozen.step({{&x, 1, ETLC_F32}}), ETLC_OK) << etlc_message();
    etlc_counts counts{};
    ASSERT_EQ(etlc_count(frozen, 0, &counts), ETLC_OK);
    EXPECT_EQ(counts.missing, 3U);
    EXPECT_EQ(counts.held, 1U);
    EXPECT_EQ(frozen.verdicts[0].status & (ETLC_SATISFIED | ETLC_VIOLATED), 0U);
}

TEST(Interface, AlarmsRestartsAndResets) {
    Opened dock(options_of(kDock));
    Seen seen;
    seen.charge = 0;
    seen.z[0] = 5;
    for (int step = 0; step < 3; ++step) ASSERT_EQ(dock.step(seen.samples()), ETLC_OK);
    EXPECT_TRUE(etlc_is_alarm(dock.verdicts[0]));
    EXPECT_FALSE(etlc_is_alarm(dock.verdicts[1]));
    std::uint64_t position = 0;
    ASSERT_EQ(etlc_position(dock, 2, &position), ETLC_OK);
    EXPECT_EQ(position, 0U);
    ASSERT_EQ(etlc_restart(dock, 1), ETLC_OK);
    ASSERT_EQ(dock.step(seen.samples()), ETLC_OK);
    ASSERT_EQ(etlc_position(dock, 1, &position), ETLC_OK);
    EXPECT_EQ(position, 3U);
    ASSERT_EQ(etlc_reset(dock), ETLC_OK);
    ASSERT_EQ(dock.step(Seen().samples()), ETLC_OK);
    EXPECT_FALSE(etlc_is_alarm(dock.verdicts[0]));
    std::uint64_t steps = 0;
    ASSERT_EQ(etlc_steps(dock, &steps), ETLC_OK);
    EXPECT_EQ(steps, 1U);
}

TEST(Interface, FinishesWhatSlidingMonitorsOwe) {
    Opened dock(options_of(kDock));
    ASSERT_EQ(dock.step(Seen().samples()), ETLC_OK);
    EXPECT_EQ(dock.verdicts[2].status, 0U);
    std::vector<etlc_verdict> verdicts(3);
    ASSERT_EQ(etlc_finish(dock, verdicts.data(), 3), ETLC_OK);
    ASSERT_EQ(etlc_finish(dock, verdicts.data(), 3), ETLC_OK);
    EXPECT_EQ(verdicts[2].robustness, 5.0F);
    expect_refused(dock.step(Seen().samples()), ETLC_ENDED, "etlc_reset()");
    ASSERT_EQ(etlc_reset(dock), ETLC_OK);
    EXPECT_EQ(dock.step(Seen().samples()), ETLC_OK);
}

TEST(Interface, RunsAnEpisodeAsItSteps) {
    constexpr std::uint32_t kSteps = 9;
    struct Row {
        float charge = 1;
        float z[3] = {};
        std::uint8_t stop = 0;
    };
    std::vector<Row> rows(kSteps);
    std::vector<std::uint8_t> present(kSteps, 1);
    Opened stepped(options_of(kDock));
    std::vector<etlc_verdict> expected;
    for (std::uint32_t n = 0; n < kSteps; ++n) {
        rows[n] = {n % 4 == 3 ? 0.125F : 1.0F, {0.25F * static_cast<float>(n), 0, 0.5F}, n == 5};
        present[n] = n % 3 != 2;
        const std::vector<etlc_sample> samples = {{present[n] != 0 ? rows[n].z : nullptr, 3, 0},
                                                  {&rows[n].charge, 1, ETLC_F32},
                                                  {&rows[n].stop, 1, ETLC_BOOL},
                                                  {nullptr, 0, 0},
                                                  {nullptr, 0, 0},
                                                  {nullptr, 0, 0}};
        ASSERT_EQ(stepped.step(samples), ETLC_OK) << etlc_message();
        expected.insert(expected.end(), stepped.verdicts.begin(), stepped.verdicts.end());
    }
    const etlc_column columns[] = {{rows[0].z, present.data(), sizeof(Row), 3, ETLC_F32},
                                   {&rows[0].charge, nullptr, sizeof(Row), 1, ETLC_F32},
                                   {&rows[0].stop, nullptr, sizeof(Row), 1, ETLC_BOOL},
                                   {},
                                   {},
                                   {}};
    const Opened run(options_of(kDock));
    std::vector<etlc_verdict> verdicts(expected.size());
    ASSERT_EQ(etlc_run(run, columns, 6, kSteps, verdicts.data(), verdicts.size()), ETLC_OK)
        << etlc_message();
    EXPECT_EQ(std::memcmp(verdicts.data(), expected.data(), expected.size() * sizeof expected[0]),
              0);
}

TEST(Interface, OpensWithConstantsSet) {
    etlc_options options = options_of("spec t; const n = 1; input x : f32; monitor m = F x > n;");
    const char* settings[] = {"n=0.25"};
    options.settings = settings;
    options.setting_count = 1;
    Opened t(options);
    const float x = 1;
    ASSERT_EQ(t.step({{&x, 1, ETLC_F32}}), ETLC_OK);
    EXPECT_EQ(t.verdicts[0].robustness, 0.75F);
}

TEST(Interface, OpensWithTruthValuesAndNarrowTargets) {
    etlc_options options = options_of(kDock);
    options.values = ETLC_BOOLEAN;
    options.targets_as = ETLC_AS_I8;
    Opened dock(options);
    ASSERT_EQ(dock.step(Seen().samples()), ETLC_OK);
    EXPECT_EQ(dock.verdicts[1].robustness, INFINITY);
}

TEST(Interface, MovesAdaptiveThresholds) {
    etlc_options options = ETLC_OPTIONS;
    options.path = ETLC_SOURCE_DIR "/tests/spec/ok/adaptive.etl";
    const Opened adaptive(options);
    etlc_predicate predicate{};
    predicate.struct_size = sizeof predicate;
    std::uint32_t p = 0;
    while (etlc_describe_predicate(adaptive, p, &predicate) == ETLC_OK && !predicate.is_adaptive)
        ++p;
    ASSERT_EQ(predicate.is_adaptive, 1U);
    etlc_measured before{};
    etlc_measured after{};
    ASSERT_EQ(etlc_measure(adaptive, p, &before), ETLC_OK);
    ASSERT_EQ(etlc_observe(adaptive, p, 1e6F, 1), ETLC_OK) << etlc_message();
    ASSERT_EQ(etlc_measure(adaptive, p, &after), ETLC_OK);
    EXPECT_NE(before.threshold, after.threshold);
    ASSERT_EQ(etlc_reset(adaptive), ETLC_OK);
    ASSERT_EQ(etlc_measure(adaptive, p, &before), ETLC_OK);
    EXPECT_EQ(before.threshold, after.threshold) << "a reset keeps it";
}

TEST(Interface, ExplainsTheLastVerdict) {
    etlc_options options = options_of(kDock);
    options.history = 10;
    Opened dock(options);
    Seen seen;
    for (int step = 0; step < 6; ++step) {
        seen.charge = step >= 2 ? 0.125F : 1.0F;
        seen.z[0] = 4;
        ASSERT_EQ(dock.step(seen.samples()), ETLC_OK);
    }
    ASSERT_TRUE(etlc_is_alarm(dock.verdicts[0]));
    const char* text = nullptr;
    ASSERT_EQ(etlc_explain(dock, 0, ETLC_TEXT, &text), ETLC_OK) << etlc_message();
    EXPECT_NE(std::string(text).find("violated for good"), std::string::npos) << text;
    EXPECT_NE(std::string(text).find("is_low holds at step 2"), std::string::npos) << text;
    ASSERT_EQ(etlc_explain(dock, 0, ETLC_JSON, &text), ETLC_OK) << etlc_message();
    EXPECT_EQ(text[0], '{');
    ASSERT_EQ(etlc_reset(dock), ETLC_OK);
    expect_refused(etlc_explain(dock, 0, ETLC_TEXT, &text), ETLC_UNDECIDED, "no verdict yet");
    ASSERT_EQ(dock.step(Seen().samples()), ETLC_OK);
    EXPECT_EQ(etlc_explain(dock, 1, ETLC_TEXT, &text), ETLC_OK) << etlc_message();
}

TEST(Interface, TakesTheOptionsOfVersion1) {
    etlc_options old = options_of(kDock);
    old.api_version = 1;
    old.struct_size = offsetof(etlc_options, recorder);
    old.recorder = "what lies behind them is not read";
    Opened dock(old);
    ASSERT_EQ(dock.step(Seen().samples()), ETLC_OK);
    std::uint32_t complete = 0, lost = 0;
    expect_refused(etlc_incidents(dock, &complete, &lost), ETLC_NOT_KEPT, "options.recorder");
}

}  // namespace
}  // namespace etlc::tests
