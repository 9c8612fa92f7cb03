// Tests the incidents of a session, and wrong calls for them. same_incidents.cpp compares the
// bytes.
#include <etlc.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>

#include "opened.hpp"

namespace etlc::tests {
namespace {

/// `returns` raises an alarm three steps after `charge` is low.
void alarm(Opened& dock) {
    Seen seen;
    seen.charge = 0;
    seen.z[0] = 5;
    for (int step = 0; step < 4; ++step) ASSERT_EQ(dock.step(seen.samples()), ETLC_OK);
}

TEST(Incidents, AreKeptUntilTheyAreForgotten) {
    etlc_options options = options_of(kDock);
    options.recorder = "0.2s,1,2";
    Opened dock(options);
    const auto expect_counts = [&](std::uint32_t complete, std::uint32_t lost) {
        std::uint32_t found = 99, found_lost = 99;
        ASSERT_EQ(etlc_incidents(dock, &found, &found_lost), ETLC_OK) << etlc_message();
        EXPECT_EQ(found, complete);
        EXPECT_EQ(found_lost, lost);
    };
    alarm(dock);
    expect_counts(0, 0);
    ASSERT_EQ(etlc_close_incidents(dock), ETLC_OK);
    expect_counts(1, 0);
    const void* bytes = nullptr;
    std::size_t size = 0;
    ASSERT_EQ(etlc_incident(dock, 0, &bytes, &size), ETLC_OK) << etlc_message();
    EXPECT_EQ(std::memcmp(bytes,
                          "\x89"
                          "ETLINC\n",
                          8),
              0);
    // 4 rows: a step, 3 predicates and the nearest rows of 3 distances; a bool and 3 verdicts.
    EXPECT_EQ(size, 96U + 4 * (4 * (1 + 3 + 3) + 1 + 3) + 8);
    for (int episode = 0; episode < 2; ++episode) {
        ASSERT_EQ(etlc_reset(dock), ETLC_OK);
        alarm(dock);
    }
    ASSERT_EQ(etlc_reset(dock), ETLC_OK);
    expect_counts(2, 1);
    ASSERT_EQ(etlc_forget_incidents(dock), ETLC_OK);
    expect_counts(0, 0);
    etlc_description spec{};
    spec.struct_size = sizeof spec;
    ASSERT_EQ(etlc_describe(dock, &spec), ETLC_OK);
    const std::uint64_t with_recorder = spec.state_bytes;
    ASSERT_EQ(etlc_describe(Opened(options_of(kDock)), &spec), ETLC_OK);
    EXPECT_GT(with_recorder, spec.state_bytes);
}

TEST(Incidents, CallsThatAreWrong) {
    std::uint32_t index = 0;
    etlc_options recording = options_of(kDock);
    recording.recorder = "2,1,1";
    const Opened recorded(recording);
    const void* bytes = nullptr;
    std::size_t size = 0;
    expect_refused(etlc_incidents(recorded, nullptr, &index), ETLC_NULL_POINTER, "complete");
    expect_refused(etlc_incidents(recorded, &index, nullptr), ETLC_NULL_POINTER, "lost");
    expect_refused(etlc_incident(recorded, 0, nullptr, &size), ETLC_NULL_POINTER, "bytes");
    expect_refused(etlc_incident(recorded, 0, &bytes, nullptr), ETLC_NULL_POINTER, "size");
    expect_refused(etlc_incident(recorded, 0, &bytes, &size), ETLC_NO_SUCH,
                   "no incident 0: 0 of them are complete");
}

}  // namespace
}  // namespace etlc::tests
