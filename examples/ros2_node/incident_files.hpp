// Writes incidents of the flight recorder to files for `etlc incident`.
// Takes: the monitor after each step. Gives: a file for each complete incident. Keeps true: no file
// is overwritten, and a file gets its name only when it is complete; if writing fails it is tried
// again, and the incident stays in the recorder.
#pragma once

#include <cstdint>
#include <string>

#include "patrol.hpp"

namespace patrol_node {

/// The options in CMakeLists.txt: the steps of two seconds before an alarm and of one second after
/// it, and room for four alarms.
inline constexpr std::uint32_t kMostIncidents = 4;

class IncidentFiles {
public:
    explicit IncidentFiles(std::string folder) : folder_(std::move(folder)) {}

    void write(patrol::Monitor& monitor);

    std::uint64_t written() const { return written_; }
    std::uint64_t lost() const { return lost_; }
    const std::string& last() const { return last_; }
    /// The reason why an incident is not in a file; empty if all are.
    const std::string& mistake() const { return mistake_; }

private:
    bool write(const patrol::Monitor& monitor, std::uint32_t incident);

    std::string folder_;
    std::uint32_t done_ = 0;    ///< number of incidents in the recorder that are in files
    std::uint64_t number_ = 0;  ///< number of the next file
    std::uint64_t written_ = 0;
    std::uint64_t lost_ = 0;  ///< before the recorder was emptied, and since
    std::uint64_t lost_before_ = 0;
    std::string last_;
    std::string mistake_;
};

}  // namespace patrol_node
