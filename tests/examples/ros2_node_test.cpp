// Tests the logic of the node of examples/ros2_node without ROS.
#include "monitor_node.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

namespace patrol_node {
namespace {

constexpr float kHall[] = {0, 1, 0, 0}, kDock[] = {1, 0, 0, 0}, kPerson[] = {0, 0, 1, 0};

class Node : public testing::Test {
protected:
    Node()
        : folder_(std::filesystem::path(testing::TempDir()) /
                  testing::UnitTest::GetInstance()->current_test_info()->name()) {
        std::filesystem::remove_all(folder_);
        std::filesystem::create_directories(folder_);
        node_.emplace(folder_.string());
    }

    Report see(const float (&z)[4]) {
        node_->take(z, 4);
        return node_->tick();
    }
    Report see(const float (&z)[4], int ticks) {
        for (; ticks > 1; --ticks) see(z);
        return see(z);
    }
    /// A person is present for longer than half a second.
    Report alarm() { return see(kPerson, 6); }

    std::vector<std::string> files() const {
        std::vector<std::string> names;
        for (const auto& entry : std::filesystem::directory_iterator(folder_))
            names.push_back(entry.path().filename().string());
        std::sort(names.begin(), names.end());
        return names;
    }

    std::filesystem::path folder_;
    std::optional<MonitorNode> node_;
};

const Status& named(const std::vector<Status>& statuses, const std::string& name) {
    for (const Status& status : statuses)
        if (status.name == "patrol: " + name) return status;
    ADD_FAILURE() << "there is no status " << name;
    return statuses.front();
}

TEST_F(Node, PublishesVerdictsWhenOneChanges) {
    EXPECT_TRUE(see(kHall).verdicts_changed) << "the first ones";
    EXPECT_FALSE(see(kHall, 10).verdicts_changed);
    const Report there = see(kDock);
    EXPECT_TRUE(there.verdicts_changed);
    EXPECT_EQ(named(there.verdicts, "arrives").message, "satisfied for good");
    EXPECT_EQ(named(there.verdicts, "arrives").level, Level::ok);
    EXPECT_EQ(named(there.verdicts, "gives_way").message, "satisfied so far");
    EXPECT_EQ(there.diagnostics.size(), 5U);
}

TEST_F(Node, OnlyAnAlarmIsAnError) {
    const Report near = see(kPerson, 5);
    EXPECT_EQ(named(near.verdicts, "gives_way").level, Level::ok);
    EXPECT_EQ(named(near.verdicts, "gives_way").message, "not satisfied yet");
    const Report alarm = see(kPerson);
    EXPECT_EQ(named(alarm.verdicts, "gives_way").level, Level::error);
    EXPECT_EQ(named(alarm.verdicts, "gives_way").message, "violated for good");
    EXPECT_TRUE(alarm.verdicts_changed);
    EXPECT_FALSE(named(alarm.verdicts, "gives_way").values.empty());
}

TEST_F(Node, UsesAnEmbeddingOnceAndTheNewestOne) {
    see(kHall);
    node_->take(kDock, 4);
    node_->take(kHall, 4);
    const Report newest = node_->tick();
    EXPECT_EQ(named(newest.verdicts, "arrives").message, "not satisfied yet");
    EXPECT_EQ(named(newest.diagnostics, "embeddings").values[1].value, "1");
    // Two ticks use the held embedding, the next ones have none.
    node_->tick();
    const Report held = node_->tick();
    EXPECT_EQ(named(held.diagnostics, "embeddings").level, Level::stale);
    EXPECT_EQ(named(held.diagnostics, "embeddings").message, "none for 2 ticks");
    EXPECT_EQ(named(held.diagnostics, "embeddings").values[3].value, "0");
    const Report missing = node_->tick();
    EXPECT_EQ(named(missing.diagnostics, "embeddings").values[3].value, "1");
    EXPECT_EQ(named(missing.verdicts, "gives_way").level, Level::warn);
    EXPECT_EQ(named(see(kHall).diagnostics, "embeddings").level, Level::ok);
}

TEST_F(Node, RefusesEmbeddingsOfAnotherSize) {
    node_->take(kDock, 3);
    node_->take(nullptr, 0);
    node_->take(kDock, 3);
    const Report report = node_->tick();
    const Status& status = named(report.diagnostics, "embeddings");
    EXPECT_EQ(status.level, Level::error);
    EXPECT_EQ(status.message, "one has 3 elements, expected 4");
    EXPECT_EQ(status.values[2].value, "3");
    EXPECT_NE(named(report.verdicts, "arrives").message, "satisfied for good");
}

TEST_F(Node, KnowsWhetherTheEncoderIsThatOfCalibration) {
    const auto status = [&] { return named(node_->tick().diagnostics, "encoder"); };
    EXPECT_EQ(status().level, Level::warn) << "nothing is known yet";
    // What encode.py makes of the frames of `etlc embed --write-reference`, to six digits.
    std::vector<float> rows = {0.404191F, 0.479545F, 0.578909F, 0.105458F, 0.502219F, 0.596844F,
                               0.3969F,   0.11468F,  0.59652F,  0.413343F, 0.498936F, 0.110381F,
                               0.39376F,  0.500466F, 0.599884F, 0.117783F};
    node_->take_references(rows.data(), rows.size());
    EXPECT_EQ(status().level, Level::ok) << status().message;
    EXPECT_EQ(status().message, "is the one of calibration");
    EXPECT_EQ(status().values.size(), 4U);
    node_->take_references(rows.data(), 12);
    EXPECT_EQ(status().level, Level::error);
    EXPECT_EQ(status().message, "shows 12 elements for the 4 reference frames, expected 16");
    std::swap(rows[0], rows[2]);  // blue and red
    node_->take_references(rows.data(), rows.size());
    EXPECT_EQ(status().level, Level::error);
    EXPECT_EQ(status().message, "is not the one of calibration: verdicts mean nothing");
}

TEST_F(Node, WhatIsNotFiniteIsMissing) {
    const float broken[] = {1, 0, NAN, 0};
    EXPECT_EQ(named(see(broken).verdicts, "gives_way").level, Level::warn);
}

TEST_F(Node, WritesIncidents) {
    alarm();
    EXPECT_TRUE(files().empty()) << "it waits for the steps after the alarm";
    node_->reset();
    EXPECT_EQ(files(), std::vector<std::string>{"patrol-incident-0"});
    std::ifstream file(folder_ / "patrol-incident-0", std::ios::binary);
    char magic[8] = {};
    file.read(magic, 8);
    EXPECT_EQ(std::string(magic, 8),
              "\x89"
              "ETLINC\n");
}

TEST_F(Node, MakesRoomForMoreIncidentsAndWritesOverNone) {
    std::ofstream(folder_ / "patrol-incident-2") << "of another run";
    for (int episode = 0; episode < 9; ++episode) {
        alarm();
        node_->reset();
    }
    EXPECT_EQ(files().size(), 10U);
    EXPECT_EQ(std::filesystem::file_size(folder_ / "patrol-incident-2"), 14U);
    const Report report = see(kHall);
    const Status& status = named(report.diagnostics, "incidents");
    EXPECT_EQ(status.level, Level::ok);
    EXPECT_EQ(status.values[0].value, "9");
    EXPECT_EQ(status.values[1].value, "0");
    EXPECT_EQ(status.values[2].value, (folder_ / "patrol-incident-9").string());
}

TEST_F(Node, SaysThatAnIncidentCannotBeWrittenAndTriesAgain) {
    std::filesystem::remove_all(folder_);
    alarm();
    node_->reset();
    const Report report = see(kHall);
    const Status& status = named(report.diagnostics, "incidents");
    EXPECT_EQ(status.level, Level::error);
    EXPECT_NE(status.message.find("patrol-incident-0: No such file"), std::string::npos)
        << status.message;
    std::filesystem::create_directories(folder_);
    EXPECT_EQ(named(see(kHall).diagnostics, "incidents").level, Level::ok);
    EXPECT_EQ(files(), std::vector<std::string>{"patrol-incident-0"});
}

TEST_F(Node, CountsAlarmsForWhichThereIsNoRoom) {
    std::filesystem::remove_all(folder_);
    for (int episode = 0; episode < 6; ++episode) {
        alarm();
        node_->reset();
    }
    std::filesystem::create_directories(folder_);
    const Report report = see(kHall);
    EXPECT_EQ(files().size(), 4U);
    EXPECT_EQ(named(report.diagnostics, "incidents").level, Level::warn);
    EXPECT_EQ(named(report.diagnostics, "incidents").values[1].value, "2");
    alarm();
    node_->reset();
    EXPECT_EQ(files().size(), 5U);
    const Report later = see(kHall);
    EXPECT_EQ(named(later.diagnostics, "incidents").values[1].value, "2");
}

}  // namespace
}  // namespace patrol_node
