#include "embed/worker/prepare.hpp"

#include <algorithm>

namespace etlc::embed::worker {

namespace {

/// Where a pixel lies between two of the image, along an axis: pixel centres are at half numbers.
struct Between {
    int low = 0;
    int high = 0;
    float part = 0;  ///< of the way
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

}  // namespace

/// Only the pixels that count are looked at.
void prepare(const Frame& frame, const Settings& settings, std::vector<float>& image) {
    const std::vector<Between> rows = between(frame.height, settings.height);
    const std::vector<Between> columns = between(frame.width, settings.width);
    const std::size_t pixels = rows.size() * columns.size();
    const std::size_t line_bytes = std::size_t(kChannels) * std::size_t(frame.width);
    float* to = image.data();
    for (const Between& row : rows) {
        const std::uint8_t* const upper = frame.rgb.data() + std::size_t(row.low) * line_bytes;
        const std::uint8_t* const lower = frame.rgb.data() + std::size_t(row.high) * line_bytes;
        for (const Between& column : columns) {
            for (int c = 0; c < kChannels; ++c) {
                const auto mixed = [&](const std::uint8_t* line) {
                    const float left = line[kChannels * column.low + c];
                    return left + column.part * (line[kChannels * column.high + c] - left);
                };
                const float above = mixed(upper);
                const float value = above + row.part * (mixed(lower) - above);
                to[static_cast<std::size_t>(c) * pixels] =
                    (value / 255.0F - settings.mean[c]) / settings.deviation[c];
            }
            ++to;
        }
    }
}

}  // namespace etlc::embed::worker
