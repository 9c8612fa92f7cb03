// Incidents of the flight recorder, as files that `etlc incident` reads.
// Takes: the monitor after each step. Gives: a file for each incident that is complete. Keeps true:
// no file is written over, and none is there by its name before it is whole; an incident that
// cannot be written is tried again, and stays in the recorder until it is.
#pragma once

#include <cstdint>
#include <string>

#include "patrol.hpp"

namespace patrol_node {

/// As CMakeLists.txt says to etlc: the steps of two seconds before an alarm, those of one second
/// after it, and room for four alarms.
inline constexpr std::uint32_t kMostIncidents = 4;

class IncidentFiles {
public:
    explicit IncidentFiles(std::string folder) : folder_(std::move(folder)) {}

    void write(patrol::Monitor& monitor);

    std::uint64_t written() const { return written_; }
    std::uint64_t lost() const { return lost_; }
    const std::string& last() const { return last_; }
    /// Why one is not in a file; empty where all are.
    const std::string& mistake() const { return mistake_; }

private:
    bool write(const patrol::Monitor& monitor, std::uint32_t incident);

    std::string folder_;
    std::uint32_t done_ = 0;    ///< of those in the recorder
    std::uint64_t number_ = 0;  ///< of the next file
    std::uint64_t written_ = 0;
    std::uint64_t lost_ = 0;  ///< before the recorder was emptied, and since
    std::uint64_t lost_before_ = 0;
    std::string last_;
    std::string mistake_;
};

}  // namespace patrol_node
