#include "embed/worker/prepare.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "embed/worker/worker.hpp"
#include "recordings/frames/protocol.hpp"

namespace etlc::embed::worker {

namespace {

using recordings::frames::kRefused;

/// Pillow's filters, by the distance from the centre.
double weight(Filter filter, double x) {
    x = std::abs(x);
    if (filter == Filter::bilinear) return std::max(1 - x, 0.0);
    constexpr double kA = -0.5;  // Keys, Cubic Convolution Interpolation, 1981
    if (x < 1) return ((kA + 2) * x - (kA + 3)) * x * x + 1;
    return x < 2 ? (((x - 5) * x + 8) * x - 4) * kA : 0;
}

/// The pixels that make one of the result, along an axis, with their weights in fixed point.
struct Window {
    int first = 0;
    std::vector<std::int32_t> weights;
};

constexpr int kPrecisionBits = 32 - 8 - 2;  // sums of 8-bit pixels fit into 32 bits

/// Computes as Pillow's precompute_coeffs() and normalize_coeffs_8bpc().
std::vector<Window> windows(int of_frame, int wanted, Filter filter) {
    const double scale = static_cast<double>(of_frame) / wanted;
    const double stretch = std::max(scale, 1.0);
    const double support = (filter == Filter::bilinear ? 1 : 2) * stretch;
    std::vector<Window> result;
    for (int i = 0; i < wanted; ++i) {
        const double centre = (i + 0.5) * scale;
        const int first = std::max(static_cast<int>(centre - support + 0.5), 0);
        const int end = std::min(static_cast<int>(centre + support + 0.5), of_frame);
        std::vector<double> weights;
        double sum = 0;
        for (int x = first; x < end; ++x) {
            weights.push_back(weight(filter, (x - centre + 0.5) * (1 / stretch)));
            sum += weights.back();
        }
        Window& window = result.emplace_back();
        window.first = first;
        for (const double one : weights) {
            const double share = sum == 0 ? one : one / sum;
            window.weights.push_back(static_cast<std::int32_t>((share < 0 ? -0.5 : 0.5) +
                                                               share * (1 << kPrecisionBits)));
        }
    }
    return result;
}

/// Computes a pixel of the result. `from`: the first of the window; `stride`: to the next.
std::uint8_t mean_of(const Window& window, const std::uint8_t* from, std::size_t stride) {
    std::int32_t sum = 1 << (kPrecisionBits - 1);
    for (const std::int32_t weight : window.weights) {
        sum += *from * weight;
        from += stride;
    }
    return static_cast<std::uint8_t>(std::clamp(sum >> kPrecisionBits, 0, 255));
}

Frame resize_columns(const Frame& frame, int width, Filter filter) {
    if (width == frame.width) return frame;
    const std::vector<Window> all = windows(frame.width, width, filter);
    Frame result(frame.height, width);
    for (int r = 0; r < frame.height; ++r) {
        std::uint8_t* to = result.row(r);
        for (const Window& window : all)
            for (int c = 0; c < kChannels; ++c)
                *to++ = mean_of(window, frame.row(r) + kChannels * window.first + c, kChannels);
    }
    return result;
}

Frame resize_rows(const Frame& frame, int height, Filter filter) {
    if (height == frame.height) return frame;
    const std::vector<Window> all = windows(frame.height, height, filter);
    const std::size_t line_bytes = std::size_t(kChannels) * std::size_t(frame.width);
    Frame result(height, frame.width);
    std::uint8_t* to = result.rgb.data();
    for (const Window& window : all)
        for (std::size_t i = 0; i < line_bytes; ++i)
            *to++ = mean_of(window, frame.row(window.first) + i, line_bytes);
    return result;
}

/// Resizes a frame to the size in the settings, as Pillow's Image.resize does: each pixel is a
/// weighted mean of those below the filter, whose width grows with the reduction; columns first,
/// then rows, in 8 bits. The longer side is rounded down, as in torchvision and transformers.
Frame resized(const Frame& frame, const Settings& settings) {
    std::int64_t height = settings.resized_height, width = settings.resized_width;
    if (settings.shorter > 0) {
        const std::int64_t least = std::min(frame.height, frame.width);
        height = std::int64_t{settings.shorter} * frame.height / least;
        width = std::int64_t{settings.shorter} * frame.width / least;
    }
    const auto size = [](std::int64_t rows, std::int64_t columns) {
        return std::to_string(rows) + " x " + std::to_string(columns);
    };
    if (height < settings.height || width < settings.width)
        refuse(kRefused, "takes images of " + size(settings.height, settings.width) +
                             ", and 'resize' makes a frame of " + size(frame.height, frame.width) +
                             " smaller: " + size(height, width));
    if (std::max(height, width) > std::int64_t{recordings::frames::kMaxExtent} ||
        height * width > std::int64_t{recordings::frames::kMaxPixels})
        refuse(kRefused, "takes frames of " + size(frame.height, frame.width) +
                             " that 'resize' makes too large: " + size(height, width));
    return resize_rows(resize_columns(frame, static_cast<int>(width), settings.filter),
                       static_cast<int>(height), settings.filter);
}

/// Returns spare / 2, rounded down as in transformers, or to the even number as by torchvision's
/// center_crop.
int margin(int spare, bool down) {
    return spare / 2 + (!down && spare % 4 == 3 ? 1 : 0);
}

/// Writes the channels of a pixel to their planes.
class Planes {
public:
    Planes(const Settings& settings, std::vector<float>& image)
        : settings_(settings), pixels_(settings.elements() / kChannels), to_(image.data()) {}

    void put(int channel, float value) {
        const int plane = settings_.blue_first ? kChannels - 1 - channel : channel;
        to_[static_cast<std::size_t>(plane) * pixels_] =
            (value / 255.0F - settings_.mean[channel]) / settings_.deviation[channel];
    }
    void next() { ++to_; }

private:
    const Settings& settings_;
    std::size_t pixels_;
    float* to_;
};

void put_centre(const Frame& frame, const Settings& settings, Planes planes) {
    const int top = margin(frame.height - settings.height, settings.margins_down);
    const int left = margin(frame.width - settings.width, settings.margins_down);
    for (int r = 0; r < settings.height; ++r) {
        const std::uint8_t* from = frame.row(top + r) + kChannels * left;
        for (int c = 0; c < settings.width; ++c, from += kChannels, planes.next())
            for (int channel = 0; channel < kChannels; ++channel)
                planes.put(channel, from[channel]);
    }
}

/// The position of a pixel between two of the image, along an axis; pixel centres are at half
/// numbers.
struct Between {
    int low = 0;
    int high = 0;
    float part = 0;  ///< fraction of the distance
};

std::vector<Between> between(int of_image, int wanted) {
    std::vector<Between> result;
    for (int i = 0; i < wanted; ++i) {
        const double at = std::max((i + 0.5) * of_image / wanted - 0.5, 0.0);
        const int low = std::min(static_cast<int>(at), of_image - 1);
        result.push_back({low, std::min(low + 1, of_image - 1), static_cast<float>(at - low)});
    }
    return result;
}

/// Reads only the pixels that contribute.
void put_interpolated(const Frame& frame, const Settings& settings, Planes planes) {
    const std::vector<Between> columns = between(frame.width, settings.width);
    for (const Between& row : between(frame.height, settings.height)) {
        const std::uint8_t* const upper = frame.row(row.low);
        const std::uint8_t* const lower = frame.row(row.high);
        for (const Between& column : columns) {
            for (int c = 0; c < kChannels; ++c) {
                const auto mixed = [&](const std::uint8_t* line) {
                    const float left = line[kChannels * column.low + c];
                    return left + column.part * (line[kChannels * column.high + c] - left);
                };
                const float above = mixed(upper);
                planes.put(c, above + row.part * (mixed(lower) - above));
            }
            planes.next();
        }
    }
}

}  // namespace

Frame turned(const Frame& frame, const Turn& turn) {
    const std::ptrdiff_t line = std::ptrdiff_t{kChannels} * frame.width;
    const std::ptrdiff_t down = turn.from_bottom ? -line : line;
    const std::ptrdiff_t along = turn.from_right ? -kChannels : kChannels;
    const std::ptrdiff_t first = (turn.from_bottom ? line * (frame.height - 1) : 0) +
                                 (turn.from_right ? line - kChannels : 0);
    Frame result(turn.swaps ? frame.width : frame.height, turn.swaps ? frame.height : frame.width);
    std::uint8_t* to = result.rgb.data();
    for (int r = 0; r < result.height; ++r) {
        std::ptrdiff_t from = first + r * (turn.swaps ? along : down);
        for (int c = 0; c < result.width; ++c, from += turn.swaps ? down : along)
            to = std::copy_n(frame.rgb.data() + from, kChannels, to);
    }
    return result;
}

void prepare(const Frame& frame, const Settings& settings, std::vector<float>& image) {
    const bool flips = settings.mirrored || settings.upside_down;
    const Frame other =
        flips
            ? turned(frame, {.from_bottom = settings.upside_down, .from_right = settings.mirrored})
            : Frame();
    const Frame& seen = flips ? other : frame;
    const Planes planes(settings, image);
    if (settings.filter == Filter::none) return put_interpolated(seen, settings, planes);
    put_centre(resized(seen, settings), settings, planes);
}

}  // namespace etlc::embed::worker
