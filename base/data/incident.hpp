// What a monitor's flight recorder wrote: the steps around an alarm, docs/data.md.
// Takes: bytes that may be anything. Gives: the incident, or what is wrong with them.
// Keeps true: nothing of a file is believed before its checksum fits; what is given has at least
// one row, all rows of one shape, and its alarm among them.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "diag/diag.hpp"

namespace etlc::data {

struct Incident {
    struct Row {
        std::uint32_t step = 0;  ///< of the episode
        std::vector<std::uint32_t> figures;
        std::vector<std::uint8_t> bytes;  ///< of bools, then of verdicts
    };
    // What the monitor was made from, as XXH64.
    std::uint64_t spec = 0;
    std::uint64_t data = 0;
    std::uint64_t thresholds = 0;
    std::uint64_t columns = 0;
    std::uint32_t before = 0;  ///< steps that the recorder keeps before an alarm; rows may be fewer
    std::uint32_t after = 0;
    std::uint32_t episode = 0;  ///< ended episodes before
    std::uint32_t number = 0;   ///< incidents before
    std::uint32_t lost = 0;     ///< alarms without an incident, when it was written
    std::uint32_t alarm = 0;    ///< row
    std::vector<Row> rows;
};

/// More than a recorder within the limits of etlc writes.
inline constexpr std::uint64_t kMaxIncidentBytes = std::uint64_t{1} << 30U;

diag::Result<Incident> parse_incident(std::string_view bytes);

}  // namespace etlc::data
