// Tests .h5 traces through the reader process: element types, shapes, groups, links, damage, and
// readers that crash.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "recordings/episodes.hpp"
#include "recordings/hdf5/hdf5.hpp"
#include "recordings/open.hpp"

namespace etlc::recordings {

using namespace data;
namespace {

namespace fs = std::filesystem;
using diag::Code;
using Kind = Channel::Kind;

const std::string kFile = ETLC_SOURCE_DIR "/tests/unit/data/trace.h5";
const std::string kDamaged = ETLC_SOURCE_DIR "/tests/fuzz/corpus/fuzz_hdf5/";

class Hdf5Trace : public testing::Test {
protected:
    void SetUp() override { ::setenv("ETLC_HDF5_READER", ETLC_HDF5_READER_PATH, 1); }

    /// Returns the error of reading these channels to the end.
    static diag::Failure failure(const std::string& path, const std::vector<Channel>& channels) {
        auto trace = open_trace(path, channels);
        if (!trace) return trace.failure();
        Sample sample;
        for (;;) {
            const auto more = (*trace)->next(sample);
            if (!more) return more.failure();
            if (!*more) return {Code::unreadable_trace, "nothing is wrong"};
        }
    }
    static std::string message(const std::vector<Channel>& channels) {
        return failure(kFile, channels).message;
    }
};

TEST_F(Hdf5Trace, StepsOfEveryKind) {
    const std::vector<Channel> channels{{"z", Kind::vector, 3},
                                        {"z_half", Kind::vector, 3},
                                        {"z_big_endian", Kind::vector, 3},
                                        {"z_packed", Kind::vector, 3},
                                        {"gripper", Kind::scalar, 1},
                                        {"column", Kind::scalar, 1},
                                        {"held", Kind::boolean, 1},
                                        {"truth.none", Kind::boolean, 1, true},
                                        {"held_int", Kind::boolean, 1},
                                        {"gripper", Kind::vector, 1}};
    auto trace = open_trace(kFile, channels);
    ASSERT_TRUE(trace) << trace.failure().message;
    EXPECT_EQ((*trace)->length(), 7U);
    EXPECT_FALSE((*trace)->has(7));
    EXPECT_TRUE((*trace)->has(6));
    Sample sample;
    for (int t = 0; t < 7; ++t) {
        const auto more = (*trace)->next(sample);
        ASSERT_TRUE(more) << more.failure().message;
        ASSERT_TRUE(*more);
        for (const int z : {0, 1, 2, 3})
            EXPECT_EQ(sample.values[z], (std::vector<double>{t + 0.0, t + 0.25, t + 0.5})) << z;
        for (const int g : {4, 5, 9})
            EXPECT_EQ(sample.values[g], std::vector<double>{t / 8.0}) << g;
        for (const int b : {6, 8})
            EXPECT_EQ(sample.values[b], std::vector<double>{t % 2 + 0.0}) << b;
        EXPECT_FALSE(sample.present[7]);
    }
    const auto more = (*trace)->next(sample);
    ASSERT_TRUE(more);
    EXPECT_FALSE(*more);
}

TEST_F(Hdf5Trace, WhatIsNotFiniteIsMissing) {
    auto trace = open_trace(kFile, {{"not_finite", Kind::scalar, 1}});
    ASSERT_TRUE(trace);
    Sample sample;
    for (int t = 0; t < 7; ++t) {
        ASSERT_TRUE(*(*trace)->next(sample));
        EXPECT_EQ(std::isnan(sample.values[0][0]), t == 3 || t == 4);
    }
}

TEST_F(Hdf5Trace, OfAGroup) {
    const std::vector<Channel> channels{{"obs/z", Kind::vector, 3},
                                        {"truth.at_a", Kind::boolean, 1, true}};
    auto trace = open_trace(kFile + ":data/demo_2", channels);
    ASSERT_TRUE(trace) << trace.failure().message;
    Sample sample;
    for (int t = 0; t < 7; ++t) {
        ASSERT_TRUE(*(*trace)->next(sample));
        EXPECT_EQ(sample.values[0], (std::vector<double>{t + 2.0, t + 2.25, t + 2.5}));
        EXPECT_EQ(sample.values[1], std::vector<double>{t > 2 ? 1.0 : 0.0});
    }
    EXPECT_EQ(failure(kFile + ":data/demo_3", channels).message,
              "no group 'data/demo_3'; there are 'column', 'cube', 'data', 'elsewhere', "
              "'external', 'gripper', 'held', 'held_int' and 12 more");
}

TEST_F(Hdf5Trace, GroupsOfAFileAreEpisodes) {
    diag::Sink sink;
    const std::vector<std::string> found = find_episodes({kFile}, {"data/demo_*[0-9]", {}}, sink);
    EXPECT_EQ(found, (std::vector<std::string>{kFile + ":data/demo_1", kFile + ":data/demo_10",
                                               kFile + ":data/demo_2"}));
    EXPECT_EQ(find_episodes({kFile}, {"", {}}, sink), std::vector<std::string>{kFile});
    EXPECT_FALSE(sink.has_errors());
    EXPECT_TRUE(find_episodes({kFile}, {"nothing/*", {}}, sink).empty());
    EXPECT_TRUE(find_episodes({kFile}, {"data/*", {}}, sink).empty());
    ASSERT_EQ(sink.errors(), 2U);
    EXPECT_EQ(sink.sorted()[0].message, "none of its groups matches 'nothing/*'");
    EXPECT_EQ(
        sink.sorted()[1].message,
        "has a group with a name that cannot be printed or is too long: 'data/demo_\\x1b[31m'");
}

TEST_F(Hdf5Trace, NamesWhatIsNotThere) {
    EXPECT_EQ(message({{"zz", Kind::vector, 3}}),
              "no dataset 'zz'; there are 'column', 'cube', 'data', 'elsewhere', 'external', "
              "'gripper', 'held', 'held_int' and 12 more");
    EXPECT_EQ(failure(kFile, {{"zz", Kind::vector, 3}}).code, Code::no_such_channel);
    EXPECT_EQ(message({{"data", Kind::vector, 3}}), "'data' is no dataset");
    EXPECT_EQ(message({{"z/below", Kind::vector, 3}}).substr(0, 20), "no dataset 'z/below'");
}

TEST_F(Hdf5Trace, ShapesFitTheirInputs) {
    EXPECT_EQ(message({{"z", Kind::vector, 4}}),
              "array 'z': has shape (7, 3), expected (steps, 4)");
    EXPECT_EQ(message({{"cube", Kind::vector, 3}}),
              "array 'cube': has shape (7, 3, 2), expected (steps, 3)");
    EXPECT_EQ(message({{"one", Kind::scalar, 1}}),
              "array 'one': has shape (), expected (steps,) or (steps, 1)");
    EXPECT_EQ(message({{"z", Kind::vector, 3}, {"short", Kind::scalar, 1}}),
              "arrays differ in length: 'z' has 7 steps, 'short' has 5");
    EXPECT_EQ(message({{"none", Kind::vector, 3}}), "nothing is wrong");  // an episode without
                                                                          // steps
}

TEST_F(Hdf5Trace, ElementsFitTheirInputs) {
    EXPECT_EQ(message({{"text", Kind::scalar, 1}}),
              "dataset 'text' has elements that are neither numbers nor bools");
    EXPECT_EQ(message({{"pairs", Kind::scalar, 1}}),
              "dataset 'pairs' has elements that are neither numbers nor bools");
    EXPECT_EQ(message({{"held", Kind::scalar, 1}}),
              "array 'held': has bool elements, expected numbers: the input is no bool");
    EXPECT_EQ(message({{"gripper", Kind::boolean, 1}}),
              "array 'gripper': holds 0.125 in step 1, expected 0 or 1");
}

TEST_F(Hdf5Trace, NothingLeadsOutOfTheFile) {
    for (const char* link : {"soft", "external"})
        EXPECT_EQ(message({{link, Kind::vector, 3}}),
                  "'" + std::string(link) + "' is a soft or external link, which is not followed");
    for (const char* dataset : {"elsewhere", "virtual"})
        EXPECT_EQ(message({{dataset, Kind::scalar, 1}}),
                  "dataset '" + std::string(dataset) +
                      "' keeps its data in other files, which are not read");
}

TEST_F(Hdf5Trace, UnknownPackingIsNamed) {
    const diag::Failure found =
        failure(ETLC_SOURCE_DIR "/tests/unit/data/lzf.h5", {{"z", Kind::vector, 3}});
    EXPECT_EQ(found.code, Code::malformed_trace_array);
    EXPECT_EQ(found.message,
              "array 'z': dataset 'z' is packed by the filter 'lzf' (number 32000), which is not "
              "read; pack it again with compression='gzip' in h5py, or by 'h5repack -f GZIP=4 "
              "OLD.h5 NEW.h5'");
}

TEST_F(Hdf5Trace, WhatKillsTheReaderIsAMessage) {
    const std::vector<Channel> channels{{"z", Kind::vector, 2},
                                        {"p", Kind::vector, 2},
                                        {"g", Kind::scalar, 1},
                                        {"b", Kind::boolean, 1}};
    EXPECT_EQ(failure(kDamaged + "trace.h5", channels).message, "nothing is wrong");
    for (const char* name :
         {"crashes_reading_1.h5", "crashes_reading_2.h5", "crashes_reading_3.h5"}) {
        const diag::Failure found = failure(kDamaged + name, channels);
        EXPECT_EQ(found.code, Code::malformed_trace_array) << name << ": " << found.message;
    }
    for (const char* name :
         {"crashes_listing_1.h5", "crashes_listing_2.h5", "crashes_listing_3.h5"}) {
        const auto found = list_hdf5(kDamaged + name, "*/*");
        ASSERT_FALSE(found) << name;
        EXPECT_EQ(found.failure().code, Code::malformed_trace_array) << found.failure().message;
    }
}

/// A shell script in place of the reader.
class Hdf5Reader : public testing::Test {
protected:
    void SetUp() override {
        reader_ = fs::path(testing::TempDir()) /
                  ("etlc_fake_reader_" + std::to_string(::getpid()) + ".sh");
        ::setenv("ETLC_HDF5_READER", reader_.c_str(), 1);
    }
    void TearDown() override { fs::remove(reader_); }

    std::string message(const std::string& script) const {
        std::ofstream(reader_) << "#!/bin/sh\n" << script << "\n";
        fs::permissions(reader_, fs::perms::owner_all);
        auto trace = open_trace(kFile, {{"g", Kind::scalar, 1}});
        if (!trace) return trace.failure().message;
        Sample sample;
        for (;;) {
            const auto more = (*trace)->next(sample);
            if (!more) return more.failure().message;
            if (!*more) return "nothing is wrong";
        }
    }

    fs::path reader_;
};

const std::string kDied = "is damaged or too much to read: the process that read it ";
const std::string kNonsense = "is damaged: what came back from reading it makes no sense";
const std::string kShapes = R"(printf 'S\011\000\000\000number 2\n';)";
const std::string kRow = R"(printf 'R\010\000\000\000\000\000\000\000\000\000\360\077';)";  // 1.0

TEST_F(Hdf5Reader, IsNotTrusted) {
    EXPECT_EQ(message(kShapes + kRow + kRow + R"(printf 'E\000\000\000\000')"), "nothing is wrong");
    EXPECT_EQ(message("kill -SEGV $$"), kDied + "was stopped by signal 11 (Segmentation fault)");
    EXPECT_EQ(message("exit 3"), kDied + "ended too soon, with exit status 3");
    EXPECT_EQ(message(kShapes + kRow + "kill -XCPU $$"),
              "array 'g': " + kDied + "was stopped by signal 24 (CPU time limit exceeded)");
    EXPECT_EQ(message(kShapes + kRow + kRow),
              "array 'g': " + kDied + "ended too soon, with exit status 0");
    EXPECT_EQ(message(kShapes + kRow + R"(printf 'E\000\000\000\000')"), "array 'g': " + kNonsense);
    EXPECT_EQ(message(kShapes + kRow + R"(printf 'R\007\000\000\0001234567')"),
              "array 'g': " + kNonsense);
    EXPECT_EQ(message(R"(printf 'S\377\377\377\377')"), kNonsense);
    EXPECT_EQ(message(R"(printf 'S\012\000\000\000number 2x\n')"), kNonsense);
    EXPECT_EQ(message(R"(printf 'S\007\000\000\000absent\n')"), kNonsense);
    EXPECT_EQ(message(R"(printf 'F\006\000\000\000fa\033[1m')"), "a?[1m");
}

TEST_F(Hdf5Reader, MayBeMissing) {
    ::setenv("ETLC_HDF5_READER", "/no/such/reader", 1);
    const auto trace = open_trace(kFile, {{"g", Kind::scalar, 1}});
    ASSERT_FALSE(trace);
    EXPECT_EQ(trace.failure().message, "'/no/such/reader' cannot be run, which reads HDF5 files");
}

}  // namespace
}  // namespace etlc::recordings
