// What is done to a frame before a network sees it, whichever runs it.
// Takes: red, green and blue bytes, row by row from the top. Gives: float32, channels x rows x
// columns. Keeps true: the same bytes and settings give the same floats.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace etlc::embed::worker {

inline constexpr int kChannels = 3;

struct Settings {
    int height = 0;
    int width = 0;
    float mean[kChannels] = {};
    float deviation[kChannels] = {};

    std::size_t elements() const {
        return std::size_t(kChannels) * std::size_t(height) * std::size_t(width);
    }
};

struct Frame {
    int height = 0;
    int width = 0;
    std::vector<std::uint8_t> rgb;
};

/// Resized in float32 by bilinear interpolation, without smoothing; then (x / 255 - mean) /
/// deviation, the channels red, green, blue one after the other. `image`: has room for all of them.
void prepare(const Frame& frame, const Settings& settings, std::vector<float>& image);

}  // namespace etlc::embed::worker
