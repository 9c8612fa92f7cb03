// Tests incidents as files: what a recorder wrote is read, and anything else is refused.
#include <gtest/gtest.h>

#include "data/files/hash.hpp"
#include "etlmon/temporal/recorder.hpp"
#include "recordings/incident.hpp"

namespace etlc::recordings {

using namespace data;
namespace {

using diag::Code;

constexpr std::uint32_t kAlarm = etlmon::Verdict::kViolated | etlmon::Verdict::kFinal;

/// Three steps, the last of which is an alarm: two figures, one bool and one verdict each.
std::string written() {
    using Row = etlmon::RecorderRow<2, 1, 1>;
    etlmon::Recorder<Row, 4, 0, 2> recorder;
    for (std::uint32_t step = 0; step < 3; ++step) {
        Row row;
        row.figures(0, 0.25F * static_cast<float>(step), 10 + step);
        row.flag(0, step > 0);
        recorder.record(row, {step == 2 ? kAlarm : 0});
    }
    recorder.close();
    std::string bytes;
    recorder.write(0, {1, 2, 3, 4}, [&](const std::uint8_t* data, std::size_t size) {
        bytes.append(reinterpret_cast<const char*>(data), size);
    });
    return bytes;
}

Code code_of(const std::string& bytes) {
    const auto result = parse_incident(bytes);
    EXPECT_FALSE(result);
    return result ? Code{} : result.failure().code;
}

/// Updates the checksum for the current bytes.
std::string sealed(std::string bytes) {
    const std::uint64_t sum = xxh64(std::string_view(bytes).substr(0, bytes.size() - 8));
    for (std::size_t i = 0; i < 8; ++i)
        bytes[bytes.size() - 8 + i] = static_cast<char>(sum >> (8 * i));
    return bytes;
}

TEST(Incident, IsReadAsItWasWritten) {
    const auto incident = parse_incident(written());
    ASSERT_TRUE(incident);
    EXPECT_EQ(incident->spec, 1U);
    EXPECT_EQ(incident->data, 2U);
    EXPECT_EQ(incident->thresholds, 3U);
    EXPECT_EQ(incident->columns, 4U);
    EXPECT_EQ(incident->before, 4U);
    EXPECT_EQ(incident->after, 0U);
    EXPECT_EQ(incident->alarm, 2U);
    ASSERT_EQ(incident->rows.size(), 3U);
    const Incident::Row& last = incident->rows.back();
    EXPECT_EQ(last.step, 2U);
    EXPECT_EQ(last.figures, (std::vector<std::uint32_t>{0x3f000000U, 12U}));
    EXPECT_EQ(last.bytes, (std::vector<std::uint8_t>{1, kAlarm | etlmon::kAlarmBegins}));
}

TEST(Incident, EveryBitCounts) {
    const std::string bytes = written();
    for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
        std::string changed = bytes;
        changed[bit / 8] = static_cast<char>(changed[bit / 8] ^ (1 << (bit % 8)));
        const bool in_magic_or_version = bit < std::size_t{8} * 12;
        EXPECT_EQ(code_of(changed),
                  in_magic_or_version ? Code::unknown_incident_format : Code::damaged_incident)
            << "bit " << bit;
    }
}

TEST(Incident, EveryByteCounts) {
    const std::string bytes = written();
    for (std::size_t size = 0; size < bytes.size(); ++size)
        EXPECT_EQ(code_of(bytes.substr(0, size)),
                  size < 8 ? Code::unknown_incident_format : Code::damaged_incident);
    EXPECT_EQ(code_of(bytes + '\0'), Code::damaged_incident);
    EXPECT_EQ(code_of(bytes + bytes), Code::damaged_incident);
}

/// Changes a number of the header, and updates the checksum.
TEST(Incident, AHeadThatContradictsItsRowsIsRefused) {
    const std::size_t words = 48, row_bytes = 52, rows = 76, alarm = 80;
    for (const std::size_t at : {words, row_bytes, rows, alarm})
        for (const char value : {'\0', '\x7f', '\xff'}) {
            if (at == alarm && value == '\0') continue;  // for the first row it would be valid
            std::string changed = written();
            changed.replace(at, 4, std::string(4, value));
            EXPECT_EQ(code_of(sealed(changed)), Code::damaged_incident) << at;
        }
}

}  // namespace
}  // namespace etlc::recordings
