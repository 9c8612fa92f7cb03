// How far a long command is, on the terminal.
// Keeps true: nothing is shown where standard error is not a terminal, and what was shown is wiped
// at the end.
#pragma once

#include <fmt/format.h>
#include <unistd.h>

#include <functional>

#include "driver/process/process.hpp"

namespace etlc::driver {

constexpr char kEraseProgress[] = "\r                                        \r";

inline bool progress_is_seen() {
    return isatty(STDERR_FILENO) != 0;
}

/// Shows how many episodes are done; empty where nobody would see it.
inline std::function<void(std::size_t done, std::size_t total)> episodes_progress() {
    if (!progress_is_seen()) return {};
    return [](std::size_t done, std::size_t total) {
        print_error(fmt::format("\r{} of {} episodes", done, total));
        if (done == total) print_error(kEraseProgress);
    };
}

}  // namespace etlc::driver
