// Sends the frames of a file at the speed at which they were taken, for `etlc watch`.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "embed/worker/decoder.hpp"

namespace etlc::embed::worker {

/// Writes the present time of the machine's steady clock, in microseconds, before a frame.
void write_stamp();

class Pace {
public:
    /// `real`: without it, `stamp` does nothing.
    Pace(const AVStream* stream, bool real);

    /// Waits until the picture is due, and writes the time.
    void stamp(const AVFrame& picture, std::int64_t frame);

private:
    double seconds_;        ///< seconds per unit of time stamps
    double frame_seconds_;  ///< seconds per frame, where pictures have no time stamp
    bool real_;
    double first_ = 0;
    std::optional<std::chrono::steady_clock::time_point> begin_;
};

}  // namespace etlc::embed::worker
