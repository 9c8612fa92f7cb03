// One run of a program among faults.
// Takes: the program's words and what shall go wrong around it. Gives: how it ended and what it
// said.
#pragma once

#include <sys/resource.h>

#include <optional>
#include <string>
#include <vector>

namespace etlc::faults {

enum class Stream { open, full, closed };

/// What is around a process. As it stands, nothing goes wrong.
struct Surroundings {
    std::string injection;  ///< as inject.cpp takes it
    std::string counts;     ///< the file that it writes the number of calls to
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

/// A process that has been started.
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

/// Where the library is that Surroundings::injection needs.
inline constexpr const char* kInjectionLibrary = ETLC_INJECTION_LIBRARY;

}  // namespace etlc::faults
