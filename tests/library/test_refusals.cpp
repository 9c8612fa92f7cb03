// Tests wrong calls: each returns a status and a message, and changes nothing.
#include <etlc.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstring>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "opened.hpp"

namespace etlc::tests {
namespace {

struct Call {
    const char* name;
    std::function<etlc_status(etlc_session)> make;
};

/// Every function that takes a session, called as it should be.
std::vector<Call> calls() {
    static etlc_description spec{};
    static etlc_input input{};
    static etlc_monitor monitor{};
    static etlc_predicate predicate{};
    static etlc_measured measured{};
    static etlc_counts counts{};
    static etlc_verdict verdicts[3];
    static const char* text = nullptr;
    static std::uint32_t index = 0;
    static std::uint64_t number = 0;
    static const void* bytes = nullptr;
    static std::size_t size = 0;
    static const Seen seen;
    static const std::vector<etlc_sample> samples = seen.samples();
    static const etlc_column columns[6] = {};
    spec.struct_size = sizeof spec;
    input.struct_size = sizeof input;
    monitor.struct_size = sizeof monitor;
    predicate.struct_size = sizeof predicate;
    return {
        {"close", [](etlc_session s) { return etlc_close(s); }},
        {"describe", [](etlc_session s) { return etlc_describe(s, &spec); }},
        {"describe_input", [](etlc_session s) { return etlc_describe_input(s, 0, &input); }},
        {"describe_monitor", [](etlc_session s) { return etlc_describe_monitor(s, 0, &monitor); }},
        {"describe_predicate",
         [](etlc_session s) { return etlc_describe_predicate(s, 0, &predicate); }},
        {"describe_let", [](etlc_session s) { return etlc_describe_let(s, 0, &text); }},
        {"find", [](etlc_session s) { return etlc_find(s, ETLC_INPUTS, "z", &index); }},
        {"step", [](etlc_session s) { return etlc_step(s, samples.data(), 6, verdicts, 3); }},
        {"run", [](etlc_session s) { return etlc_run(s, columns, 6, 1, verdicts, 3); }},
        {"finish", [](etlc_session s) { return etlc_finish(s, verdicts, 3); }},
        {"reset", [](etlc_session s) { return etlc_reset(s); }},
        {"restart", [](etlc_session s) { return etlc_restart(s, 1); }},
        {"observe", [](etlc_session s) { return etlc_observe(s, 0, 1, 1); }},
        {"steps", [](etlc_session s) { return etlc_steps(s, &number); }},
        {"position", [](etlc_session s) { return etlc_position(s, 0, &number); }},
        {"measure", [](etlc_session s) { return etlc_measure(s, 0, &measured); }},
        {"let", [](etlc_session s) { return etlc_let(s, 0, verdicts); }},
        {"count", [](etlc_session s) { return etlc_count(s, 0, &counts); }},
        {"explain", [](etlc_session s) { return etlc_explain(s, 0, ETLC_TEXT, &text); }},
        {"incidents", [](etlc_session s) { return etlc_incidents(s, &index, &index); }},
        {"incident", [](etlc_session s) { return etlc_incident(s, 0, &bytes, &size); }},
        {"close_incidents", [](etlc_session s) { return etlc_close_incidents(s); }},
        {"forget_incidents", [](etlc_session s) { return etlc_forget_incidents(s); }},
    };
}

etlc_session open_dock() {
    const etlc_options options = options_of(kDock);
    etlc_session session = 0;
    EXPECT_EQ(etlc_open(&options, &session), ETLC_OK) << etlc_message();
    return session;
}

TEST(Refusals, EveryCallKnowsASessionThatIsClosed) {
    const etlc_session session = open_dock();
    ASSERT_EQ(etlc_close(session), ETLC_OK);
    const etlc_session later = open_dock();
    EXPECT_NE(session, later);
    for (const Call& call : calls()) {
        for (const etlc_session closed : {session, etlc_session{0}, ~etlc_session{0},
                                          etlc_session{77}, later + (etlc_session{1} << 32U)}) {
            SCOPED_TRACE(call.name);
            expect_refused(call.make(closed), ETLC_NO_SESSION, "is not open");
        }
    }
    EXPECT_EQ(etlc_close(later), ETLC_OK);
}

TEST(Refusals, ACallThatSucceedsHasNoMessage) {
    const etlc_session session = open_dock();
    expect_refused(etlc_steps(session, nullptr), ETLC_NULL_POINTER, "steps is null");
    std::uint64_t steps = 0;
    EXPECT_EQ(etlc_steps(session, &steps), ETLC_OK);
    EXPECT_STREQ(etlc_message(), "");
    EXPECT_STREQ(etlc_message_json(), "{\"diagnostics\": []}\n");
    EXPECT_EQ(etlc_close(session), ETLC_OK);
}

TEST(Refusals, NullPointers) {
    const etlc_options options = options_of(kDock);
    etlc_session none = 0;
    expect_refused(etlc_open(nullptr, &none), ETLC_NULL_POINTER, "options is null");
    expect_refused(etlc_open(&options, nullptr), ETLC_NULL_POINTER, "session is null");
    etlc_options empty = ETLC_OPTIONS;
    expect_refused(etlc_open(&empty, &none), ETLC_NULL_POINTER, "options.path");
    empty.text = kDock;
    empty.setting_count = 1;
    expect_refused(etlc_open(&empty, &none), ETLC_NULL_POINTER, "options.settings");
    const char* setting = nullptr;
    empty.settings = &setting;
    expect_refused(etlc_open(&empty, &none), ETLC_NULL_POINTER, "an element of options.settings");
    EXPECT_EQ(none, 0U);

    const Opened dock(options);
    etlc_verdict verdicts[3];
    const std::vector<etlc_sample> samples(6);
    const std::vector<etlc_column> columns(6);
    std::uint32_t index = 0;
    expect_refused(etlc_describe(dock, nullptr), ETLC_NULL_POINTER, "description is null");
    expect_refused(etlc_describe_input(dock, 0, nullptr), ETLC_NULL_POINTER, "description");
    expect_refused(etlc_describe_monitor(dock, 0, nullptr), ETLC_NULL_POINTER, "description");
    expect_refused(etlc_describe_predicate(dock, 0, nullptr), ETLC_NULL_POINTER, "description");
    expect_refused(etlc_describe_let(dock, 0, nullptr), ETLC_NULL_POINTER, "name is null");
    expect_refused(etlc_find(dock, ETLC_INPUTS, nullptr, &index), ETLC_NULL_POINTER, "name");
    expect_refused(etlc_find(dock, ETLC_INPUTS, "z", nullptr), ETLC_NULL_POINTER, "index");
    expect_refused(etlc_step(dock, nullptr, 6, verdicts, 3), ETLC_NULL_POINTER, "samples");
    expect_refused(etlc_step(dock, samples.data(), 6, nullptr, 3), ETLC_NULL_POINTER, "verdicts");
    expect_refused(etlc_run(dock, nullptr, 6, 1, verdicts, 3), ETLC_NULL_POINTER, "columns");
    expect_refused(etlc_run(dock, columns.data(), 6, 1, nullptr, 3), ETLC_NULL_POINTER, "verdicts");
    expect_refused(etlc_finish(dock, nullptr, 3), ETLC_NULL_POINTER, "verdicts");
    expect_refused(etlc_steps(dock, nullptr), ETLC_NULL_POINTER, "steps");
    expect_refused(etlc_position(dock, 0, nullptr), ETLC_NULL_POINTER, "position");
    expect_refused(etlc_measure(dock, 0, nullptr), ETLC_NULL_POINTER, "measured");
    expect_refused(etlc_inner_threshold(dock, 0, nullptr), ETLC_NULL_POINTER, "threshold");
    expect_refused(etlc_let(dock, 0, nullptr), ETLC_NULL_POINTER, "verdict");
    expect_refused(etlc_count(dock, 0, nullptr), ETLC_NULL_POINTER, "counts");
    expect_refused(etlc_explain(dock, 0, ETLC_TEXT, nullptr), ETLC_NULL_POINTER, "text");
}

TEST(Refusals, OtherVersions) {
    etlc_session none = 0;
    etlc_options options = options_of(kDock);
    options.struct_size -= 8;
    expect_refused(etlc_open(&options, &none), ETLC_WRONG_VERSION, "struct_size of options");
    options = options_of(kDock);
    for (const std::uint32_t version : {0U, ETLC_API_VERSION + 1}) {
        options.api_version = version;
        expect_refused(etlc_open(&options, &none), ETLC_WRONG_VERSION,
                       "options.api_version is " + std::to_string(version));
    }
    options.api_version = 1;  // with shorter options
    expect_refused(etlc_open(&options, &none), ETLC_WRONG_VERSION, "struct_size of options");
    const Opened dock(options_of(kDock));
    etlc_description spec{};
    etlc_input input{};
    etlc_monitor monitor{};
    etlc_predicate predicate{};
    expect_refused(etlc_describe(dock, &spec), ETLC_WRONG_VERSION, "is 0, expected");
    expect_refused(etlc_describe_input(dock, 0, &input), ETLC_WRONG_VERSION, "is 0, expected");
    expect_refused(etlc_describe_monitor(dock, 0, &monitor), ETLC_WRONG_VERSION, "is 0, expected");
    expect_refused(etlc_describe_predicate(dock, 0, &predicate), ETLC_WRONG_VERSION, "is 0");
}

TEST(Refusals, SpecsThatDoNotCompile) {
    etlc_session none = 1;
    etlc_options options = options_of("spec t;\ninput x : f32;\nmonitor m = F y > 1;\n");
    options.path = "folder/t.etl";
    expect_refused(etlc_open(&options, &none), ETLC_REFUSED, "folder/t.etl:3:15: error: ");
    EXPECT_EQ(none, 0U);
    EXPECT_NE(std::string(etlc_message_json()).find("\"code\": \"E0204\""), std::string::npos)
        << etlc_message_json();
    for (const char* const text :
         {"", "\xff\xfe", "spec t; monitor m = (((((", "spec t; input x : f32[99999999999];"}) {
        options = options_of(text);
        expect_refused(etlc_open(&options, &none), ETLC_REFUSED, "spec.etl:");
    }
    options = ETLC_OPTIONS;
    options.path = "/there/is/no/such.etl";
    expect_refused(etlc_open(&options, &none), ETLC_REFUSED, "/there/is/no/such.etl: error: ");
    options = options_of("spec t; input x : f32; monitor m = F x > 1;");
    options.recorder = "2s,1s,4";
    expect_refused(etlc_open(&options, &none), ETLC_REFUSED, "has no rate or period");
    options.recorder = "2000000,1,1";
    expect_refused(etlc_open(&options, &none), ETLC_REFUSED, "a recorder of 1 incidents of");
    options = options_of(kDock);
    options.max_state = 8;
    expect_refused(etlc_open(&options, &none), ETLC_REFUSED, "8 bytes");
    options = ETLC_OPTIONS;
    options.path = ETLC_SOURCE_DIR "/tests/spec/ok/adaptive.etl";
    options.thresholds = "/there/is/no/thresholds.json";
    expect_refused(etlc_open(&options, &none), ETLC_REFUSED, "/there/is/no/thresholds.json");
}

TEST(Refusals, OptionsThatMeanNothing) {
    etlc_session none = 0;
    const auto refused = [&](const std::function<void(etlc_options&)>& spoil, const char* words) {
        etlc_options options = options_of(kDock);
        spoil(options);
        expect_refused(etlc_open(&options, &none), ETLC_WRONG_VALUE, words);
    };
    refused([](etlc_options& o) { o.values = 2; }, "options.values is 2");
    refused([](etlc_options& o) { o.targets_as = 3; }, "options.targets_as is 3");
    refused([](etlc_options& o) { o.lets = 2; }, "options.lets is 2");
    refused([](etlc_options& o) { o.reserved = 1; }, "options.reserved is 1");
    refused([](etlc_options& o) { o.history = ~std::uint64_t{0}; }, "options.history");
    for (const char* const recorder : {"", "2s", "2s,1s", "2s,1s,0", "2s,1s,-1", "-1,1,1", "1,1,x",
                                       "0.5,1,1", "1 h,1,1", "nan,1,1", "1,1,1,1"})
        refused([recorder](etlc_options& o) { o.recorder = recorder; },
                "expected BEFORE,AFTER,INCIDENTS");
    const char* const setting = "nonsense";
    refused(
        [&](etlc_options& o) {
            o.settings = &setting;
            o.setting_count = 1;
        },
        "options.settings takes NAME=NUMBER or NAME=DURATION, such as limit=0.25 or deadline=2s, "
        "not 'nonsense'");
    etlc_options many = options_of(kDock);
    many.settings = &setting;
    many.setting_count = ~std::size_t{0};
    expect_refused(etlc_open(&many, &none), ETLC_WRONG_NUMBER, "expected at most 10000");
    etlc_options options = options_of(kDock);
    options.history = std::uint64_t{1} << 40U;
    expect_refused(etlc_open(&options, &none), ETLC_OUT_OF_MEMORY, "not enough memory");
}

TEST(Refusals, SamplesOfOtherShapesAndTypes) {
    Opened dock(options_of(kDock));
    const Seen seen;
    const auto refused = [&](std::size_t input, etlc_sample sample, etlc_status status,
                             const char* words) {
        std::vector<etlc_sample> samples = seen.samples();
        samples[input] = sample;
        expect_refused(dock.step(samples), status, words);
    };
    refused(0, {seen.z, 2, ETLC_F32}, ETLC_WRONG_NUMBER, "'z' is given 2 elements, expected 3");
    refused(0, {seen.z, 3, ETLC_F16}, ETLC_WRONG_TYPE, "'z' is given elements of type 2, exp");
    refused(0, {seen.z, 3, 17}, ETLC_WRONG_TYPE, "type 17, expected 0 (ETLC_F32)");
    refused(2, {seen.z, 1, ETLC_F32}, ETLC_WRONG_TYPE, "expected 1 (ETLC_BOOL)");
    refused(3, {seen.half, 2, ETLC_I8}, ETLC_WRONG_TYPE, "expected 2 (ETLC_F16)");
    refused(4, {seen.byte, 2, ETLC_F32}, ETLC_WRONG_TYPE, "expected 3 (ETLC_I8)");
    const char* const odd = reinterpret_cast<const char*>(seen.z) + 1;
    refused(0, {odd, 3, ETLC_F32}, ETLC_WRONG_VALUE, "of 4 bytes are not aligned");
    refused(3, {odd, 2, ETLC_F16}, ETLC_WRONG_VALUE, "of 2 bytes are not aligned");
    const std::uint8_t two = 2;
    refused(2, {&two, 1, ETLC_BOOL}, ETLC_WRONG_VALUE, "'stop' is the bool 2");
    std::vector<etlc_sample> fewer = seen.samples();
    fewer.pop_back();
    expect_refused(dock.step(fewer), ETLC_WRONG_NUMBER, "5 samples, expected 6");
    etlc_verdict verdicts[4];
    const std::vector<etlc_sample> samples = seen.samples();
    expect_refused(etlc_step(dock, samples.data(), 6, verdicts, 2), ETLC_WRONG_NUMBER,
                   "room for 2 verdicts");
    expect_refused(etlc_finish(dock, verdicts, 4), ETLC_WRONG_NUMBER, "room for 4 verdicts");
    std::uint64_t steps = 99;
    ASSERT_EQ(etlc_steps(dock, &steps), ETLC_OK);
    EXPECT_EQ(steps, 0U) << "a refused step was made";
}

TEST(Refusals, ColumnsOfOtherShapesAndStrides) {
    const Opened dock(options_of(kDock));
    const float values[8] = {};
    const std::uint8_t flags[2] = {0, 7};
    etlc_verdict verdicts[6];
    const auto run = [&](std::size_t input, etlc_column column, std::size_t room = 6) {
        etlc_column columns[6] = {};
        columns[input] = column;
        return etlc_run(dock, columns, 6, 2, verdicts, room);
    };
    expect_refused(run(0, {values, nullptr, 12, 4, ETLC_F32}), ETLC_WRONG_NUMBER, "4 elements");
    expect_refused(run(0, {values, nullptr, 12, 3, ETLC_I8}), ETLC_WRONG_TYPE, "of type 3");
    expect_refused(run(0, {values, nullptr, 13, 3, ETLC_F32}), ETLC_WRONG_VALUE, "not aligned");
    const char* const odd = reinterpret_cast<const char*>(values) + 1;
    expect_refused(run(0, {odd, nullptr, 12, 3, ETLC_F32}), ETLC_WRONG_VALUE, "not aligned");
    expect_refused(run(2, {flags, nullptr, 1, 1, ETLC_BOOL}), ETLC_WRONG_VALUE, "the bool 7");
    expect_refused(run(0, {values, nullptr, 12, 3, ETLC_F32}, 5), ETLC_WRONG_NUMBER,
                   "room for 5 verdicts, expected 2 x 3");
    EXPECT_EQ(run(0, {values, nullptr, 0, 3, ETLC_F32}), ETLC_OK) << "the same at every step";
    const etlc_column none[6] = {};
    EXPECT_EQ(etlc_run(dock, none, 6, 0, verdicts, 0), ETLC_OK) << "no step";
    expect_refused(etlc_run(dock, none, 6, ~std::uint64_t{0}, verdicts, 6), ETLC_WRONG_NUMBER,
                   "room for 6 verdicts");
    expect_refused(etlc_run(dock, none, 5, 2, verdicts, 6), ETLC_WRONG_NUMBER, "5 columns");
    EXPECT_EQ(run(0, {values + 3, nullptr, -12, 3, ETLC_F32}), ETLC_OK) << "backwards";
}

/// Sizes that a caller made up are refused before anything as long as they are begun.
TEST(Refusals, SizesBeyondAnyMemory) {
    const Opened dock(options_of(kDock));
    constexpr std::uint64_t kHuge = std::uint64_t{1} << 40U;
    constexpr std::uint64_t kMost = ~std::uint64_t{0};
    etlc_verdict verdicts[6];
    const std::uint8_t flags[2] = {0, 1};
    const float values[8] = {};
    etlc_grid grids[6] = {};
    grids[2] = {flags, nullptr, 0, 0, 1, ETLC_BOOL};  // the same bool in all rows and steps
    const auto ahead = [&](std::uint64_t plans, std::uint64_t steps, std::size_t room) {
        return etlc_ahead(dock, grids, 6, plans, steps, 1, verdicts, room);
    };
    for (const std::uint64_t steps : {kHuge, kMost, kMost / 3 + 1})
        expect_refused(ahead(2, steps, 6), ETLC_WRONG_NUMBER, "room for 6 verdicts, expected 2 x");
    for (const std::uint64_t plans : {std::uint64_t{0}, kHuge, kMost})
        expect_refused(ahead(plans, 1, 3), ETLC_WRONG_NUMBER, "plans, expected a number from 1 to");
    expect_refused(ahead(1U << 31U, 1, 3), ETLC_WRONG_NUMBER, "expected 2147483648 x 1 x 3");
    expect_refused(ahead(1, kMost / 3, kMost), ETLC_WRONG_NUMBER, "more than any memory");
    EXPECT_EQ(ahead(std::uint64_t{1} << 32U, 0, 0), ETLC_OK) << "no step of many plans";
    expect_refused(etlc_ahead(dock, grids, 6, 1, 1, 1025, verdicts, 3), ETLC_WRONG_VALUE,
                   "threads is 1025, expected at most 1024");
    EXPECT_EQ(ahead(2, 1, 6), ETLC_OK);

    const etlc_column same[6] = {{}, {}, {flags, nullptr, 0, 1, ETLC_BOOL}};
    for (const std::uint64_t steps : {kHuge, kMost})
        expect_refused(etlc_run(dock, same, 6, steps, verdicts, 6), ETLC_WRONG_NUMBER, "room for");
    expect_refused(etlc_run(dock, same, 6, kMost / 3, verdicts, kMost), ETLC_WRONG_NUMBER,
                   "more than any memory");
    expect_refused(etlc_finish(dock, verdicts, kMost), ETLC_WRONG_NUMBER, "more than any memory");
    constexpr std::int64_t kFar = std::int64_t{1} << 62U;
    const etlc_column far[6] = {{values, nullptr, kFar, 3, ETLC_F32}};
    expect_refused(etlc_run(dock, far, 6, 2, verdicts, 6), ETLC_WRONG_VALUE, "4611686018427387904");
    grids[0] = {values, nullptr, -kFar, 0, 3, ETLC_F32};
    expect_refused(ahead(2, 1, 6), ETLC_WRONG_VALUE,
                   "'z' has 2 samples, each -4611686018427387904");
    grids[0] = {values, nullptr, 0, kFar, 3, ETLC_F32};
    expect_refused(ahead(1, 2, 6), ETLC_WRONG_VALUE, "more than any memory");
    std::uint64_t steps = 0;
    EXPECT_EQ(etlc_steps(dock, &steps), ETLC_OK);
    EXPECT_EQ(steps, 0U);
}

TEST(Refusals, BatchesBeyondTheMachine) {
    const Opened dock(options_of(kDock));
    etlc_session batch = 1;
    for (const std::uint64_t environments : {std::uint64_t{0}, (std::uint64_t{1} << 32U) + 1})
        expect_refused(etlc_open_batch(dock, environments, &batch), ETLC_WRONG_NUMBER,
                       "expected a number from 1 to 4294967296");
    expect_refused(etlc_open_batch(dock, std::uint64_t{1} << 32U, &batch), ETLC_OUT_OF_MEMORY,
                   "4294967296 environments take");
    ASSERT_EQ(etlc_open_batch(dock, 2, &batch), ETLC_OK);
    const etlc_grid grids[6] = {};
    etlc_verdict verdicts[6];
    std::uint64_t steps[2];
    etlc_measured measured[2];
    const std::uint64_t huge = std::uint64_t{1} << 40U;
    expect_refused(etlc_run_batch(batch, grids, 6, huge, 1, verdicts, 6), ETLC_WRONG_NUMBER,
                   "room for 6 verdicts");
    expect_refused(etlc_run_batch(batch, grids, huge, 1, 1, verdicts, 6), ETLC_WRONG_NUMBER,
                   "1099511627776 grids, expected 6");
    expect_refused(etlc_finish_batch(batch, nullptr, 2, verdicts, huge), ETLC_WRONG_NUMBER, "room");
    for (const std::uint64_t wrong : {std::uint64_t{1}, huge}) {
        expect_refused(etlc_reset_batch(batch, nullptr, wrong), ETLC_WRONG_NUMBER, "the 2 of the");
        expect_refused(etlc_restart_batch(batch, 1, nullptr, wrong), ETLC_WRONG_NUMBER, "the 2");
        expect_refused(etlc_steps_batch(batch, steps, wrong), ETLC_WRONG_NUMBER, "the 2 of");
        expect_refused(etlc_measure_batch(batch, 0, measured, wrong), ETLC_WRONG_NUMBER, "the 2");
    }
    EXPECT_EQ(etlc_run_batch(batch, grids, 6, 0, 1, verdicts, 0), ETLC_OK) << "no step";
    EXPECT_EQ(etlc_close(batch), ETLC_OK);
}

TEST(Refusals, WhatIsNotThere) {
    const Opened dock(options_of(kDock));
    etlc_input input{};
    input.struct_size = sizeof input;
    etlc_monitor monitor{};
    monitor.struct_size = sizeof monitor;
    etlc_predicate predicate{};
    predicate.struct_size = sizeof predicate;
    std::uint32_t index = 0;
    std::uint64_t number = 0;
    etlc_measured measured{};
    etlc_counts counts{};
    etlc_verdict verdict{};
    const char* text = nullptr;
    expect_refused(etlc_describe_input(dock, 6, &input), ETLC_NO_SUCH,
                   "no input 6: the spec has 6");
    expect_refused(etlc_describe_monitor(dock, 3, &monitor), ETLC_NO_SUCH, "no monitor 3");
    expect_refused(etlc_describe_predicate(dock, 3, &predicate), ETLC_NO_SUCH, "no predicate 3");
    expect_refused(etlc_describe_let(dock, 0, &text), ETLC_NO_SUCH, "no let 0");
    expect_refused(etlc_find(dock, ETLC_MONITORS, "nobody", &index), ETLC_NO_SUCH, "'nobody'");
    expect_refused(etlc_find(dock, 4, "z", &index), ETLC_WRONG_VALUE, "kind is 4");
    expect_refused(etlc_restart(dock, 3), ETLC_NO_SUCH, "no monitor 3");
    expect_refused(etlc_restart(dock, 0), ETLC_WRONG_VALUE, "'returns' does not restart");
    expect_refused(etlc_observe(dock, 3, 1, 1), ETLC_NO_SUCH, "no predicate 3");
    expect_refused(etlc_observe(dock, 0, 1, 1), ETLC_WRONG_VALUE, "'at_bay' is not adaptive");
    expect_refused(etlc_position(dock, 3, &number), ETLC_NO_SUCH, "no monitor 3");
    expect_refused(etlc_position(dock, 2, &number), ETLC_UNDECIDED, "'calm' has no verdict yet");
    expect_refused(etlc_measure(dock, 3, &measured), ETLC_NO_SUCH, "no predicate 3");
    float inner = 0;
    expect_refused(etlc_inner_threshold(dock, 3, &inner), ETLC_NO_SUCH, "no predicate 3");
    expect_refused(etlc_let(dock, 0, &verdict), ETLC_NOT_KEPT, "options.lets = 1");
    expect_refused(etlc_count(dock, 6, &counts), ETLC_NO_SUCH, "no input 6");
    expect_refused(etlc_explain(dock, 3, ETLC_TEXT, &text), ETLC_NO_SUCH, "no monitor 3");
    expect_refused(etlc_explain(dock, 0, 2, &text), ETLC_WRONG_VALUE, "format is 2");
    expect_refused(etlc_explain(dock, 0, ETLC_TEXT, &text), ETLC_UNDECIDED, "no verdict yet");
}

TEST(Refusals, LabelsThatAreNone) {
    etlc_options options = ETLC_OPTIONS;
    options.path = ETLC_SOURCE_DIR "/tests/spec/ok/adaptive.etl";
    const Opened adaptive(options);
    std::uint32_t p = 0;
    etlc_predicate predicate{};
    predicate.struct_size = sizeof predicate;
    while (etlc_describe_predicate(adaptive, p, &predicate) == ETLC_OK && !predicate.is_adaptive)
        ++p;
    expect_refused(etlc_observe(adaptive, p, NAN, 1), ETLC_WRONG_VALUE, "distance is nan");
    expect_refused(etlc_observe(adaptive, p, INFINITY, 1), ETLC_WRONG_VALUE, "distance is inf");
    expect_refused(etlc_observe(adaptive, p, 1, 2), ETLC_WRONG_VALUE, "truth is 2");
}

TEST(Refusals, ExplanationsWithoutAHistory) {
    const char* text = nullptr;
    Opened without(options_of(kDock));
    ASSERT_EQ(without.step(Seen().samples()), ETLC_OK);
    expect_refused(etlc_explain(without, 0, ETLC_TEXT, &text), ETLC_NOT_KEPT, "with a history");
    etlc_options options = options_of(kDock);
    options.history = 2;
    Opened with(options);
    for (int step = 0; step < 3; ++step) ASSERT_EQ(with.step(Seen().samples()), ETLC_OK);
    expect_refused(etlc_explain(with, 0, ETLC_TEXT, &text), ETLC_NOT_KEPT,
                   "the history holds 2 of the episode's 3 steps");
    ASSERT_EQ(etlc_reset(with), ETLC_OK);
    ASSERT_EQ(with.step(Seen().samples()), ETLC_OK);
    EXPECT_EQ(etlc_explain(with, 0, ETLC_TEXT, &text), ETLC_OK) << etlc_message();
}

/// If two threads share a session, one is refused sooner or later; neither breaks.
TEST(Refusals, ASessionInACallOfAnotherThread) {
    const etlc_session session = open_dock();
    constexpr std::uint64_t kSteps = 1000;
    std::atomic<bool> seen{false};
    std::thread runs([&] {
        std::vector<etlc_verdict> verdicts(3 * kSteps);
        const etlc_column columns[6] = {};
        while (!seen) {
            const etlc_status status =
                etlc_run(session, columns, 6, kSteps, verdicts.data(), verdicts.size());
            EXPECT_TRUE(status == ETLC_OK || status == ETLC_BUSY) << status;
        }
    });
    while (!seen) {
        std::uint64_t steps = 0;
        const etlc_status status = etlc_steps(session, &steps);
        if (status == ETLC_OK) continue;
        expect_refused(status, ETLC_BUSY, "another thread");
        seen = true;
    }
    runs.join();
    EXPECT_EQ(etlc_close(session), ETLC_OK);
}

TEST(Refusals, SessionsOfManyThreadsAreOpenedAndClosedAtOnce) {
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t)
        threads.emplace_back([] {
            for (int n = 0; n < 40; ++n) {
                Opened a(options_of(kDock));
                Opened b(options_of(kDock));
                EXPECT_EQ(a.step(Seen().samples()), ETLC_OK);
                EXPECT_EQ(b.step(Seen().samples()), ETLC_OK);
                EXPECT_EQ(std::memcmp(a.verdicts.data(), b.verdicts.data(), 3 * 16), 0);
            }
        });
    for (std::thread& thread : threads) thread.join();
}

}  // namespace
}  // namespace etlc::tests
