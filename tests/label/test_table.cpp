// Tests the tables that `etlc label` rewrites, and when it makes proposals from them.
#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/file.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "../evaluate/evaluated.hpp"
#include "data/files/file.hpp"
#include "episodes/labels/labels.hpp"
#include "label/desk.hpp"
#include "label/propose.hpp"
#include "label/service.hpp"
#include "label/table.hpp"
#include "npy_bytes.hpp"

namespace etlc::label {
namespace {

using diag::Code;
using episodes::Label;
using tests::file_bytes;
using tests::TemporaryPath;

const std::vector<std::string> kEpisodes{"demos/a.npz", "demos/b.npz"};

LabelsOf near_in_a(Marks marks) {
    return {"demos/a.npz", "a", "near", 20, std::move(marks)};
}

Table read(const std::string& path, double step_seconds = 0) {
    auto table = Table::read(path, kEpisodes, step_seconds);
    EXPECT_TRUE(table);
    return std::move(*table);
}

TEST(Table, IsMadeWithTheFirstLabel) {
    const TemporaryPath file("labels.csv");
    Table table = read(file.path());
    EXPECT_FALSE(table.write({near_in_a({{{2, 5}, {7, 20, Label::unknown}}})}));
    EXPECT_EQ(file_bytes(file.path()), "episode,predicate,start,end\na,near,2,5\na,?near,7,\n");
    EXPECT_FALSE(table.write({near_in_a(std::vector<Interval>())}));
    EXPECT_EQ(file_bytes(file.path()), "episode,predicate,start,end\na,!near,,\n");
    EXPECT_FALSE(table.write({near_in_a(std::nullopt)}));
    EXPECT_EQ(file_bytes(file.path()), "episode,predicate,start,end\n");
}

TEST(Table, KeepsWhatIsAboutSomethingElse) {
    const TemporaryPath file("labels.csv",
                             "predicate,episode,end,start,group\n"
                             "near,other,4,,\n,a,,,monday\nnear,a.npz,3,1,monday\nfar,a,,,\n"
                             "near,\"b\",9,8,\n");
    Table table = read(file.path());
    EXPECT_FALSE(table.write({near_in_a({{{2, 5}}})}));
    EXPECT_EQ(file_bytes(file.path()),
              "episode,predicate,start,end,group\nother,near,0,4,\na,,,,monday\n"
              "a.npz,near,2,5,monday\na,far,,,\nb,near,8,9,\n");
}

TEST(Table, KeepsTheGroupOfAnEpisodeWithoutLabels) {
    const TemporaryPath file("labels.csv", "episode,predicate,group\na,near,monday\n");
    Table table = read(file.path());
    EXPECT_FALSE(table.write({near_in_a(std::nullopt)}));
    EXPECT_EQ(file_bytes(file.path()), "episode,predicate,start,end,group\na,,,,monday\n");
}

TEST(Table, KeepsOutcomes) {
    const TemporaryPath file("labels.csv",
                             "episode,outcome,predicate,start,end\na,failure,,7,\nb,success,,,\n");
    Table table = read(file.path());
    EXPECT_FALSE(table.write({near_in_a({{{2, 5}}})}));
    EXPECT_EQ(file_bytes(file.path()),
              "episode,predicate,start,end,outcome\na,,7,,failure\nb,,,,success\na,near,2,5,\n");
    EXPECT_FALSE(table.write({near_in_a(std::nullopt)}));
    EXPECT_EQ(file_bytes(file.path()),
              "episode,predicate,start,end,outcome\na,,7,,failure\nb,,,,success\n");
}

TEST(Table, StaysInSeconds) {
    const std::string bytes = "episode,predicate,start_s,end_s\nb,near,0.15,\n";
    const TemporaryPath file("labels.csv", bytes);
    const auto without_rate = Table::read(file.path(), kEpisodes, 0);
    ASSERT_FALSE(without_rate);
    EXPECT_EQ(without_rate.failure().code, Code::steps_without_time);
    Table table = read(file.path(), 0.1);
    EXPECT_FALSE(table.write({near_in_a({{{3, 7}}})}));
    EXPECT_EQ(file_bytes(file.path()), bytes + "a,near,0.3,0.7\n");
}

/// Compared with integers: t / 10^digits seconds are t x rate / 10^digits steps.
TEST(Table, OfASpreadsheetGetsCommas) {
    const TemporaryPath file("labels.csv",
                             "\xef\xbb\xbfsep=;\r\nepisode;predicate;start_s;end_s\r\n"
                             "b;near;0,15;\r\n;;;\r\n");
    Table table = read(file.path(), 0.1);
    EXPECT_FALSE(table.write({near_in_a({{{3, 7}}})}));
    EXPECT_EQ(file_bytes(file.path()),
              "episode,predicate,start_s,end_s\nb,near,0.15,\na,near,0.3,0.7\n");
}

TEST(Seconds, AreTheStepThatTheExactDecimalSays) {
    for (const std::uint64_t rate : {10, 12, 15, 24, 25, 30, 50, 60, 100, 120, 240})
        for (const std::uint64_t unit : {1, 10, 100, 1000})
            for (std::uint64_t t = 0; t < 40 * unit; ++t) {
                const std::uint64_t step = t * rate / unit;
                const std::uint64_t tenths = 10 * (t * rate % unit);
                const double seconds = static_cast<double>(t) / static_cast<double>(unit);
                EXPECT_EQ(episodes::step_at(seconds, 1.0 / static_cast<double>(rate)),
                          tenths <= unit ? step : step + 1)
                    << t << "/" << unit << " s at " << rate << " Hz";
            }
    EXPECT_EQ(episodes::step_at(0.17, 1.0 / 30), 5U);
    EXPECT_EQ(episodes::step_at(0.171, 1.0 / 30), 6U);
}

TEST(Table, IsNotWrittenOverAnother) {
    const TemporaryPath file("labels.csv");
    Table table = read(file.path());
    std::ofstream(file.path()) << "episode,predicate\nb,near\n";
    EXPECT_TRUE(table.has_changed());
    const auto failure = table.write({near_in_a({{{2, 5}}})});
    ASSERT_TRUE(failure);
    EXPECT_NE(failure->message.find("another program"), std::string::npos);
    EXPECT_EQ(file_bytes(file.path()), "episode,predicate\nb,near\n");
}

/// Another call that compares the table, and replaces it next, has the lock of the folder.
TEST(Table, IsNotWrittenWhileAnotherCallDoes) {
    const TemporaryPath file("labels.csv");
    Table table = read(file.path());
    const data::Descriptor folder(
        ::open(std::filesystem::path(file.path()).parent_path().c_str(), O_RDONLY));
    ASSERT_EQ(::flock(*folder, LOCK_EX), 0);
    const auto failure = table.write({near_in_a({{{2, 5}}})});
    ASSERT_TRUE(failure);
    EXPECT_NE(failure->message.find("locked its folder"), std::string::npos) << failure->message;
    EXPECT_FALSE(std::filesystem::exists(file.path()));
    ASSERT_EQ(::flock(*folder, LOCK_UN), 0);
    EXPECT_FALSE(table.write({near_in_a({{{2, 5}}})}));
    EXPECT_EQ(file_bytes(file.path()), "episode,predicate,start,end\na,near,2,5\n");
}

TEST(Table, HoldsAnyNameOrRefusesIt) {
    for (const std::string name : {"a,b", "a \"b\"", " a ", "<script>", "\xE6\x97\xA5", "?a"}) {
        const TemporaryPath file("labels.csv");
        const std::vector<std::string> episodes{"demos/" + name + ".npz"};
        auto table = Table::read(file.path(), episodes, 0);
        ASSERT_TRUE(table);
        EXPECT_FALSE(table->write({{episodes[0], name, "near", 9, {{{2, 5}}}}})) << name;
        auto again = Table::read(file.path(), episodes, 0);
        ASSERT_TRUE(again);
        EXPECT_FALSE(again->write({{episodes[0], name, "near", 9, std::nullopt}})) << name;
        EXPECT_EQ(file_bytes(file.path()), "episode,predicate,start,end\n") << name;
    }
}

/// The process that makes proposals reads the labels from disk, at a time that nobody knows: found
/// where a slow machine let keys go by meanwhile, which were then taken back.
TEST(Background, ProposesAnewWhereLabelsChangedMeanwhile) {
    const TemporaryPath folder("episodes");
    std::filesystem::create_directory(folder.path());
    DeskRequest request{{}, {}, folder.path() + "/labels.csv"};
    for (int e = 0; e < 4; ++e) {
        request.episodes.push_back(fmt::format("{}/{}.csv", folder.path(), e));
        std::ofstream(request.episodes.back()) << "x\n1\n2\n";
    }
    const check::Model model = tests::model_of(
        "spec s;\ninput x : f32;\npredicate near = x < 1.5;\nmonitor m = G near;\n");
    diag::Sink sink;
    auto desk = Desk::open(model, request, sink);
    ASSERT_TRUE(desk);
    for (std::size_t e = 0; e < kEnoughLabelled; ++e)
        ASSERT_FALSE(desk->press(e, 0, Key::never, 0));
    Background background({"--gtest_list_tests"});  // of this program
    const auto wait_for = [&](std::uint64_t version) {
        while (background.version() < version || background.is_busy()) {
            background.look_after(*desk);
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
    };
    wait_for(1);
    ASSERT_FALSE(desk->press(0, 0, Key::begin, 1));
    background.look_after(*desk);
    std::this_thread::sleep_for(std::chrono::seconds(1));  // nobody presses a key
    background.look_after(*desk);
    ASSERT_TRUE(desk->undo());
    ASSERT_TRUE(desk->redo());
    wait_for(3);
}

}  // namespace
}  // namespace etlc::label
