// Turns decoded pictures into frames: red, green and blue as ffmpeg makes them by default, upright.
// Keeps true: all pictures of a source have one size and one kind of pixels; another one ends the
// process.
#pragma once

#include <cstdint>
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
    void set(const char* name, int value);
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

}  // namespace etlc::embed::worker
