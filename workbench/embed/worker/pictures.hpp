// Turns decoded pictures into frames: red, green and blue as ffmpeg makes them by default, upright.
// Keeps true: all pictures of a source have one size and one kind of pixels; another one ends the
// process.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "embed/worker/decoder.hpp"

namespace etlc::embed::worker {

/// Returns "0.1" or "29.97".
std::string number_text(double value);

class Converter {
public:
    /// `frame`: its number, for the message.
    const std::vector<std::uint8_t>& rgb(const AVFrame& picture, std::int64_t frame);

private:
    void begin(const AVFrame& picture);
    void set_colours(const AVFrame& picture);

    Scaler scaler_;
    int width_ = 0;
    int height_ = 0;
    int format_ = -1;
    int stride_ = 0;
    std::vector<std::uint8_t> rows_;
    std::vector<std::uint8_t> rgb_;
};

/// Returns the quarter turns clockwise that the file requests, as phones write it.
int quarter_turns(const AVStream* stream);

/// Writes a picture as a frame, turned clockwise by quarters.
void send(const AVFrame& picture, Converter& converter, int turns, std::int64_t frame);

// Sends the frames of a file at the speed at which they were taken, for `etlc watch`.

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
