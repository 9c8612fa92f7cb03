// Loops over the bytes of pictures, which a live page runs for each frame of a camera.
#include <algorithm>
#include <array>

#include "report/blob.hpp"
#include "report/pictures.hpp"

namespace etlc::report {

std::string base64(std::string_view bytes) {
    constexpr std::string_view kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text((bytes.size() + 2) / 3 * 4, '=');
    char* to = text.data();
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t here = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t bits = 0;
        for (std::size_t k = 0; k < 3; ++k)
            bits = bits << 8U | (k < here ? static_cast<std::uint8_t>(bytes[i + k]) : 0U);
        for (std::size_t k = 0; k <= here; ++k) to[k] = kDigits[bits >> (18 - 6 * k) & 63U];
        to += 4;
    }
    return text;
}

Picture shrunk(std::string_view pixels, std::uint32_t width, std::uint32_t height,
               std::uint32_t channels, std::uint32_t most) {
    const std::uint32_t factor = (std::max(width, height) + most - 1) / most;
    const std::size_t rows = std::min(factor, height);
    const std::size_t columns = std::min(factor, width);
    const std::size_t green = channels == 1 ? 0 : 1;
    Picture result{std::max(width / factor, 1U), std::max(height / factor, 1U), ""};
    result.pixels.resize(std::size_t{3} * result.width * result.height);
    char* to = result.pixels.data();
    for (std::size_t y = 0; y < result.height; ++y)
        for (std::size_t x = 0; x < result.width; ++x) {
            std::array<std::uint32_t, 3> sums{};
            for (std::size_t v = y * factor; v < y * factor + rows; ++v) {
                const char* from = &pixels[(v * width + x * factor) * channels];
                for (std::size_t u = 0; u < columns; ++u, from += channels)
                    for (std::size_t c = 0; c < 3; ++c)
                        sums[c] += static_cast<std::uint8_t>(from[c * green]);
            }
            for (const std::uint32_t sum : sums) *to++ = static_cast<char>(sum / (rows * columns));
        }
    return result;
}

}  // namespace etlc::report
