// Prepares frames for a network, as its training did.
// Takes: a frame, and the settings of an encoder. Gives: the image for the network. Keeps true:
// with a filter the pixels are those that Pillow computes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace etlc::embed::worker {

inline constexpr int kChannels = 3;

enum class Filter : std::uint8_t { none, bilinear, bicubic };

struct Settings {
    int height = 0;  ///< of the image for the network
    int width = 0;
    Filter filter = Filter::none;
    int shorter = 0;  ///< shorter side of the resized frame; 0: the two below
    int resized_height = 0;
    int resized_width = 0;
    bool mirrored = false;     ///< left and right change places
    bool upside_down = false;  ///< top and bottom do
    bool blue_first = false;
    bool margins_down = false;   ///< halves of margins are rounded down, not to the even number
    float mean[kChannels] = {};  ///< red, green, blue
    float deviation[kChannels] = {};

    std::size_t elements() const {
        return std::size_t(kChannels) * std::size_t(height) * std::size_t(width);
    }
};

struct Frame {
    int height = 0;
    int width = 0;
    std::vector<std::uint8_t> rgb;

    Frame() = default;
    Frame(int rows, int columns)
        : height(rows),
          width(columns),
          rgb(std::size_t(kChannels) * std::size_t(rows) * std::size_t(columns)) {}

    const std::uint8_t* row(int r) const { return rgb.data() + offset(r); }
    std::uint8_t* row(int r) { return rgb.data() + offset(r); }

private:
    std::size_t offset(int r) const {
        return std::size_t(kChannels) * std::size_t(r) * std::size_t(width);
    }
};

/// How a frame is read to turn it.
struct Turn {
    bool swaps = false;  ///< rows become columns
    bool from_bottom = false;
    bool from_right = false;
};
Frame turned(const Frame& frame, const Turn& turn);

/// Prepares a frame for a network. Flips it, then:
/// - with a filter, resizes it and cuts the centre out, as torchvision's CenterCrop does; ends the
///   process where the resized frame is smaller than the image;
/// - without one, resizes it in float32 by bilinear interpolation, without smoothing.
/// Then computes (x / 255 - mean) / deviation, channels x rows x columns. `image` has room for the
/// result.
void prepare(const Frame& frame, const Settings& settings, std::vector<float>& image);

}  // namespace etlc::embed::worker
