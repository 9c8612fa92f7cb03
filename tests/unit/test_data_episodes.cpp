// Tests sets of episodes: the meaning and order of folders and patterns, and how contents are
// compared.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>

#include "data/traces/trace_formats.hpp"
#include "recordings/episodes.hpp"
#include "recordings/open.hpp"

namespace etlc::recordings {

using namespace data;
namespace {

namespace fs = std::filesystem;
using diag::Code;
using Kind = Channel::Kind;

/// Empty files in a separate folder, removed afterwards.
class Episodes : public testing::Test {
protected:
    void SetUp() override {
        const auto* test = testing::UnitTest::GetInstance()->current_test_info();
        folder_ = fs::path(testing::TempDir()) / (std::string("etlc_episodes_") + test->name());
        fs::remove_all(folder_);
        for (const char* file : {"a/ep10.csv", "a/ep2.npz", "a/ep1.csv", "a/notes.txt",
                                 "a/below/ep0.csv", "b/ep1.csv", "b/x[1].csv"}) {
            fs::create_directories((folder_ / file).parent_path());
            std::ofstream(folder_ / file).put('\n');
        }
        fs::create_directories(folder_ / "empty");
    }
    void TearDown() override { fs::remove_all(folder_); }

    /// Returns the episodes, relative to the folder.
    std::vector<std::string> find(std::vector<std::string> arguments, diag::Sink& sink) const {
        for (std::string& argument : arguments) argument = (folder_ / argument).string();
        std::vector<std::string> found = find_episodes(arguments, {}, sink);
        for (std::string& path : found) path = fs::path(path).lexically_relative(folder_).string();
        return found;
    }
    std::vector<std::string> find(const std::vector<std::string>& arguments) const {
        diag::Sink sink;
        const auto found = find(arguments, sink);
        EXPECT_FALSE(sink.has_errors());
        return found;
    }

    fs::path folder_;
};

using Paths = std::vector<std::string>;

TEST_F(Episodes, OfAFolderAreItsTracesByName) {
    EXPECT_EQ(find({"a"}), (Paths{"a/ep1.csv", "a/ep10.csv", "a/ep2.npz"}));
    EXPECT_EQ(find({"a/"}), (Paths{"a/ep1.csv", "a/ep10.csv", "a/ep2.npz"}));
}

TEST_F(Episodes, OfAPatternAreWhatMatches) {
    EXPECT_EQ(find({"*/ep1.csv"}), (Paths{"a/ep1.csv", "b/ep1.csv"}));
    EXPECT_EQ(find({"a/ep?.*"}), (Paths{"a/ep1.csv", "a/ep2.npz"}));
    EXPECT_EQ(find({"[ab]"}),
              (Paths{"a/ep1.csv", "a/ep10.csv", "a/ep2.npz", "b/ep1.csv", "b/x[1].csv"}));
}

TEST_F(Episodes, KeepTheOrderOfTheArgumentsAndStandOnce) {
    EXPECT_EQ(find({"b/ep1.csv", "a"}),
              (Paths{"b/ep1.csv", "a/ep1.csv", "a/ep10.csv", "a/ep2.npz"}));
    EXPECT_EQ(find({"a/ep2.npz", "a/../a", "a/*.csv"}),
              (Paths{"a/ep2.npz", "a/../a/ep1.csv", "a/../a/ep10.csv"}));
}

TEST_F(Episodes, APathThatExistsIsNoPattern) {
    EXPECT_EQ(find({"b/x[1].csv"}), (Paths{"b/x[1].csv"}));
}

TEST_F(Episodes, AreMissedWhereAnArgumentHasNone) {
    diag::Sink sink;
    EXPECT_EQ(find({"no_such", "a/ep1.csv", "empty", "a/*.h", "em*"}, sink), (Paths{"a/ep1.csv"}));
    const auto findings = sink.sorted();
    ASSERT_EQ(findings.size(), 4U);
    std::set<std::string> messages;
    for (const diag::Diagnostic& finding : findings) {
        EXPECT_EQ(finding.code, Code::unreadable_trace);
        messages.insert(fs::path(finding.file).filename().string() + ": " + finding.message);
    }
    EXPECT_EQ(messages,
              (std::set<std::string>{
                  "no_such: no such file",
                  "empty: holds no episodes, expected files that end in .csv, .npz, .h5 or .hdf5",
                  "*.h: no file matches this pattern",
                  "em*: only folders match, without episodes, expected files that end in .csv, "
                  ".npz, .h5 or .hdf5",
              }));
}

std::string hash_of(Trace& trace, const std::vector<HashedInput>& inputs,
                    const std::vector<std::size_t>& counted) {
    EpisodeHash hash(inputs);
    Sample sample;
    while (*trace.next(sample)) {
        std::vector<std::vector<float>> samples;
        for (const std::size_t c : counted) {
            samples.emplace_back();
            if (sample.present[c])
                samples.back().assign(sample.values[c].begin(), sample.values[c].end());
        }
        hash.add(samples);
    }
    return hash.text();
}

std::string hash_of(const std::string& csv, const std::vector<Channel>& channels,
                    const std::vector<std::size_t>& counted) {
    auto trace = open_csv_trace(from_memory(csv), channels);
    EXPECT_TRUE(trace);
    std::vector<HashedInput> inputs;
    for (const std::size_t c : counted) inputs.push_back({channels[c].name, 1, false});
    return hash_of(**trace, inputs, counted);
}

TEST(EpisodeHash, TellsContentsApart) {
    const std::vector<Channel> channels{{"x", Kind::scalar, 1}, {"y", Kind::scalar, 1}};
    const std::vector<std::size_t> both{0, 1};
    const std::string one = hash_of("x,y\n1,2\n3,4\n", channels, both);
    EXPECT_EQ(one.size(), 16U);
    EXPECT_EQ(hash_of("y,note,x\r\n2,a,1.0\r\n4,b,3e0\r\n", channels, both), one);
    std::set<std::string> different{one};
    for (const char* csv :
         {"x,y\n3,4\n1,2\n", "x,y\n1,2\n", "x,y\n1,2\n3,4\n3,4\n", "x,y\n1,2\n3,4.0000005\n",
          "x,y\n1,2\n3,\n", "x,y\n2,1\n3,4\n", "x,y\n", "x,y\n0,0\n", "x,y\n,\n"})
        EXPECT_TRUE(different.insert(hash_of(csv, channels, both)).second) << csv;
}

TEST(EpisodeHash, LooksAtTheChannelsThatCount) {
    const std::vector<Channel> channels{{"x", Kind::scalar, 1}, {"y", Kind::scalar, 1}};
    EXPECT_EQ(hash_of("x,y\n1,2\n3,4\n", channels, {0}), hash_of("x,y\n1,5\n3,6\n", channels, {0}));
    EXPECT_NE(hash_of("x,y\n1,2\n3,4\n", channels, {1}), hash_of("x,y\n1,5\n3,6\n", channels, {1}));
}

TEST(EpisodeHash, IsThatOfTheFloat32Values) {
    const std::string folder = ETLC_SOURCE_DIR "/tests/unit/data/";
    std::string found;
    for (const char* array : {"z", "z_half"}) {  // the same numbers as float32 and as float16
        auto trace = open_trace(folder + "trace_stored.npz", {{array, Kind::vector, 3}});
        ASSERT_TRUE(trace);
        const std::string hash = hash_of(**trace, {{"z", 3, true}}, {0});
        if (found.empty()) found = hash;
        EXPECT_EQ(hash, found);
    }
    EXPECT_EQ(found, "ca8bc1bc4bf26407");  // thresholds files hold these hashes
}

}  // namespace
}  // namespace etlc::recordings
