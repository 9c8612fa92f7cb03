// Compares the flight recorder with a list of all events, from which incidents are taken by their
// definition.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "etlmon/temporal/recorder.hpp"

namespace {

using etlmon::Verdict;

constexpr uint32_t kQuiet = Verdict::kDecided | Verdict::kSatisfied;
constexpr uint32_t kAlarm = Verdict::kDecided | Verdict::kViolated | Verdict::kFinal;
constexpr etlmon::IncidentOrigin kOrigin{0x1111111111111111u, 0x2222222222222222u,
                                         0x3333333333333333u, 0x4444444444444444u};

/// Two figures, a bool and three verdicts.
using Row = etlmon::RecorderRow<2, 1, 3>;

struct Bytes {
    std::vector<uint8_t> all;
    void operator()(const uint8_t* bytes, size_t size) {
        EXPECT_LE(size, 32U);
        all.insert(all.end(), bytes, bytes + size);
    }
    uint32_t word(size_t at) const {
        return all[at] | static_cast<uint32_t>(all[at + 1]) << 8 |
               static_cast<uint32_t>(all[at + 2]) << 16 | static_cast<uint32_t>(all[at + 3]) << 24;
    }
};

/// The steps of an incident's rows, and which of them is the alarm.
struct Seen {
    uint32_t episode = 0;
    uint32_t alarm = 0;  ///< step
    std::vector<uint32_t> steps;
    std::vector<uint32_t> marks;  ///< a number unique to the step

    bool operator==(const Seen& other) const {
        return episode == other.episode && alarm == other.alarm && steps == other.steps &&
               marks == other.marks;
    }
};

/// Reads a written incident by docs/recordings.md.
Seen read(const Bytes& bytes) {
    EXPECT_TRUE(std::equal(etlmon::kIncidentMagic, etlmon::kIncidentMagic + 8, bytes.all.begin()));
    EXPECT_EQ(bytes.word(8), 1U);
    EXPECT_EQ(bytes.word(12), bytes.all.size());
    for (uint32_t i = 0; i < 4; ++i) EXPECT_EQ(bytes.word(16 + 8 * i), 0x11111111u * (i + 1));
    EXPECT_EQ(bytes.word(48), 3U);  // words per row
    EXPECT_EQ(bytes.word(52), 4U);  // bytes per row
    const uint32_t rows = bytes.word(76), alarm = bytes.word(80);
    Seen seen;
    seen.episode = bytes.word(64);
    for (uint32_t r = 0; r < rows; ++r) {
        const size_t at = 96 + 16 * r;
        seen.steps.push_back(bytes.word(at));
        seen.marks.push_back(bytes.word(at + 8));
        const bool begins = ((bytes.word(at + 12) >> 8) & 0x101010u) != 0;
        EXPECT_TRUE(begins || r != alarm) << "an incident is about an alarm that begins";
    }
    seen.alarm = seen.steps[alarm];
    const size_t content = bytes.all.size() - 8;
    EXPECT_EQ(content, (96 + 16 * rows + 31) / 32 * 32);
    etlmon::Checksum sum;
    sum.add(bytes.all.data(), content);
    EXPECT_EQ(bytes.word(content) | static_cast<uint64_t>(bytes.word(content + 4)) << 32,
              sum.value());
    return seen;
}

/// Returns the recorder's incidents, from all events.
template <uint32_t Before, uint32_t After, uint32_t Incidents>
class Twin {
public:
    using Recorder = etlmon::Recorder<Row, Before, After, Incidents>;

    void step(const std::vector<bool>& alarms) {
        Row row;
        row.figures(0, 0.5f, mark_);
        row.flag(0, true);
        recorder_.record(row, {alarms[0] ? kAlarm : kQuiet, alarms[1] ? kAlarm : kQuiet,
                               alarms[2] ? kAlarm : kQuiet});
        bool begins = false;
        for (size_t m = 0; m < alarms.size(); ++m) begins = begins || (alarms[m] && !last_[m]);
        last_ = alarms;
        marks_.push_back(mark_++);
        if (!begins) return;
        if (incidents_.size() == Incidents)
            ++lost_;
        else
            incidents_.push_back({episode_, marks_.size() - 1, marks_, false});
    }
    void end_episode() {
        expect_closed();
        recorder_.end_episode();
        if (!marks_.empty()) ++episode_;
        marks_.clear();
        last_ = {false, false, false};
    }
    void close() {
        expect_closed();
        recorder_.close();
    }
    void restart(uint32_t monitor) {
        recorder_.restart(monitor);
        last_[monitor] = false;
    }
    void forget() {
        recorder_.forget();
        incidents_.clear();
        lost_ = 0;
    }

    void expect_equal() {
        update();
        uint32_t complete = 0;
        while (complete < incidents_.size() && is_complete(incidents_[complete])) ++complete;
        ASSERT_EQ(recorder_.complete(), complete);
        ASSERT_EQ(recorder_.lost(), lost_);
        for (uint32_t n = 0; n < complete; ++n) {
            Bytes bytes;
            ASSERT_TRUE(recorder_.write(n, kOrigin, bytes));
            ASSERT_TRUE(read(bytes) == expected(incidents_[n])) << "incident " << n;
        }
        Bytes none;
        EXPECT_FALSE(recorder_.write(complete, kOrigin, none));
        EXPECT_TRUE(none.all.empty());
    }

private:
    struct Incident {
        uint32_t episode;
        size_t alarm;                 ///< step within the episode
        std::vector<uint32_t> marks;  ///< steps of the episode, while it is open
        bool closed;
    };

    void expect_closed() {
        update();
        for (Incident& incident : incidents_) incident.closed = true;
    }
    /// Adds later steps to open incidents.
    void update() {
        for (Incident& incident : incidents_)
            if (!incident.closed && incident.episode == episode_) incident.marks = marks_;
    }
    static bool is_complete(const Incident& incident) {
        return incident.closed || incident.marks.size() > incident.alarm + After + Before + 1;
    }
    static Seen expected(const Incident& incident) {
        const size_t first = incident.alarm - std::min<size_t>(incident.alarm, Before);
        const size_t end = std::min(incident.alarm + After + 1, incident.marks.size());
        Seen seen;
        seen.episode = incident.episode;
        seen.alarm = static_cast<uint32_t>(incident.alarm);
        for (size_t s = first; s < end; ++s) {
            seen.steps.push_back(static_cast<uint32_t>(s));
            seen.marks.push_back(incident.marks[s]);
        }
        return seen;
    }

    Recorder recorder_;
    std::vector<Incident> incidents_;
    std::vector<uint32_t> marks_;
    std::vector<bool> last_{false, false, false};
    uint32_t mark_ = 100;
    uint32_t episode_ = 0;
    uint32_t lost_ = 0;
};

template <uint32_t Before, uint32_t After, uint32_t Incidents>
void try_at_random(uint32_t seed) {
    std::mt19937 random(seed);
    const auto once_in = [&](uint32_t n) { return random() % n == 0; };
    for (uint32_t run = 0; run < 30; ++run) {
        Twin<Before, After, Incidents> twin;
        const uint32_t rare = 1 + static_cast<uint32_t>(random() % 12);
        for (uint32_t step = 0; step < 80; ++step) {
            twin.step({once_in(rare), once_in(2 * rare), once_in(3)});
            if (once_in(30)) twin.end_episode();
            if (once_in(40)) twin.close();
            if (once_in(60)) twin.forget();
            if (once_in(5)) twin.restart(static_cast<uint32_t>(random() % 3));
            twin.expect_equal();
            if (::testing::Test::HasFatalFailure()) return;
        }
    }
}

TEST(Recorder, IncidentsAreWhatTheyAreDefinedToBe) {
    try_at_random<0, 0, 1>(1);
    try_at_random<0, 3, 2>(2);
    try_at_random<3, 0, 2>(3);
    try_at_random<2, 3, 3>(4);
    try_at_random<5, 1, 4>(5);
    try_at_random<1, 9, 8>(6);
}

TEST(Recorder, AlarmsOneStepApartHaveAnIncidentEach) {
    etlmon::Recorder<Row, 2, 2, 4> recorder;
    for (uint32_t step = 0; step < 12; ++step)
        recorder.record(Row(), {step >= 4 ? kAlarm : kQuiet, step >= 5 ? kAlarm : kQuiet, kQuiet});
    ASSERT_EQ(recorder.complete(), 2U);
    Bytes first, second;
    recorder.write(0, kOrigin, first);
    recorder.write(1, kOrigin, second);
    EXPECT_EQ(read(first).steps, (std::vector<uint32_t>{2, 3, 4, 5, 6}));
    EXPECT_EQ(read(second).steps, (std::vector<uint32_t>{3, 4, 5, 6, 7}));
}

TEST(Recorder, AnAlarmAtTheFirstStepHasNothingBefore) {
    etlmon::Recorder<Row, 3, 1, 2> recorder;
    recorder.record(Row(), {kAlarm, kAlarm, kQuiet});
    EXPECT_EQ(recorder.complete(), 0U);
    recorder.close();
    ASSERT_EQ(recorder.complete(), 1U);
    Bytes bytes;
    recorder.write(0, kOrigin, bytes);
    EXPECT_EQ(read(bytes).steps, (std::vector<uint32_t>{0}));
}

TEST(Recorder, TheFirstAlarmsAreKeptAndTheOthersCounted) {
    etlmon::Recorder<Row, 1, 1, 2> recorder;
    for (uint32_t step = 0; step < 20; ++step)
        recorder.record(Row(), {step % 4 == 3 ? kAlarm : kQuiet, kQuiet, kQuiet});
    EXPECT_EQ(recorder.complete(), 2U);
    EXPECT_EQ(recorder.lost(), 3U);
    Bytes bytes;
    recorder.write(1, kOrigin, bytes);
    EXPECT_EQ(read(bytes).alarm, 7U);
    recorder.forget();
    EXPECT_EQ(recorder.complete(), 0U);
    EXPECT_EQ(recorder.lost(), 0U);
}

TEST(Recorder, WhatIsMissingAndWhatNobodyAskedForDiffer) {
    Row row;
    EXPECT_EQ(row.words[1], etlmon::kUnaskedBits);
    EXPECT_EQ(row.bytes[0], etlmon::kRecordedUnasked);
    row.figures(0, etlmon::detail::from_bits(0xffc12345u), 7);  // any kind of NaN
    row.flag(0, etlmon::Flag());
    EXPECT_EQ(row.words[1], etlmon::detail::kMissingBits);
    EXPECT_EQ(row.words[2], 7U);
    EXPECT_EQ(row.bytes[0], etlmon::kRecordedMissing);
    row.figure(0, -2.5f);
    EXPECT_EQ(row.words[1], 0xc0200000u);
}

}  // namespace
