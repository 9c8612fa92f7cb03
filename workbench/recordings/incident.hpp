// An incident, as a monitor's flight recorder writes it (docs/recordings.md): the steps around an
// alarm.
// Keeps true: no content of a file is used before its checksum fits; an incident has at least one
// row, all rows have one shape, and the alarm is among them.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "diag/diag.hpp"

namespace etlc::recordings {

struct Incident {
    struct Row {
        std::uint32_t step = 0;  ///< of the episode
        std::vector<std::uint32_t> figures;
        std::vector<std::uint8_t> bytes;  ///< bools, then verdicts
    };
    // The XXH64 of what the monitor was made from.
    std::uint64_t spec = 0;
    std::uint64_t data = 0;
    std::uint64_t thresholds = 0;
    std::uint64_t columns = 0;
    std::uint32_t before = 0;  ///< steps that the recorder keeps before an alarm; rows may be fewer
    std::uint32_t after = 0;
    std::uint32_t episode = 0;  ///< number of episodes that ended before
    std::uint32_t number = 0;   ///< number of incidents before
    std::uint32_t lost = 0;     ///< alarms that no room was left for, when it was written
    std::uint32_t alarm = 0;    ///< row
    std::vector<Row> rows;
};

/// Larger than any incident of a recorder within the limits of etlc.
inline constexpr std::uint64_t kMaxIncidentBytes = std::uint64_t{1} << 30U;

diag::Result<Incident> parse_incident(std::string_view bytes);

}  // namespace etlc::recordings
