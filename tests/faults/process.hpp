// One run of a program under faults.
// Takes: the program's arguments and the faults. Gives: how it ended, and its output.
#pragma once

#include <sys/resource.h>

#include <optional>
#include <string>
#include <vector>

namespace etlc::faults {

enum class Stream { open, full, closed };

/// The surroundings of a process. The default has no faults.
struct Surroundings {
    std::string injection;  ///< in the format of inject.cpp
    std::string counts;     ///< the file for the counts of calls
    Stream input = Stream::open;
    Stream output = Stream::open;
    Stream error = Stream::open;
    rlim_t file_bytes = RLIM_INFINITY;
    rlim_t address_space = RLIM_INFINITY;
    std::optional<double> killed_after{};  ///< seconds
};

struct Outcome {
    int status = -1;  ///< exit status; -1: ended by a signal
    int signal = 0;
    std::string output;
    std::string error;
};

/// A running process.
class Process {
public:
    Process(const std::vector<std::string>& words, const std::string& folder,
            const Surroundings& around);
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;
    /// Waits for its end.
    Outcome outcome();

private:
    pid_t id_ = 0;
    int output_ = -1;
    int error_ = -1;
    std::optional<double> killed_after_;
};

/// Returns the path of the library for Surroundings::injection.
inline constexpr const char* kInjectionLibrary = ETLC_INJECTION_LIBRARY;

}  // namespace etlc::faults
