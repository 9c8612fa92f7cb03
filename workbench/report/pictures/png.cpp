#include "report/pictures/png.hpp"

#include <zlib.h>

#include <algorithm>

#include "report/packing/pack.hpp"

namespace etlc::report {

namespace {

std::string big_endian(std::uint32_t number) {
    std::string bytes;
    for (const unsigned shift : {24U, 16U, 8U, 0U})
        bytes += static_cast<char>(number >> shift & 0xFFU);
    return bytes;
}

std::string chunk(const std::string& name, const std::string& data) {
    const std::string checked = name + data;
    const uLong sum =
        crc32(0, reinterpret_cast<const Bytef*>(checked.data()), static_cast<uInt>(checked.size()));
    return big_endian(static_cast<std::uint32_t>(data.size())) + checked +
           big_endian(static_cast<std::uint32_t>(sum));
}

/// Every row as it is, or its differences from the row above.
std::string filtered(const Picture& picture, bool up) {
    const std::size_t row = std::size_t{3} * picture.width;
    std::string bytes;
    for (std::size_t y = 0; y < picture.height; ++y) {
        bytes += up ? '\2' : '\0';
        for (std::size_t i = y * row; i < (y + 1) * row; ++i)
            bytes += static_cast<char>(picture.pixels[i] -
                                       (up && y > 0 ? picture.pixels[i - row] : '\0'));
    }
    return bytes;
}

}  // namespace

std::string png(const Picture& picture) {
    const std::string plain = deflated(filtered(picture, false));
    const std::string up = deflated(filtered(picture, true));
    const std::string head = big_endian(picture.width) + big_endian(picture.height) +
                             std::string("\x08\x02\x00\x00\x00", 5);  // 8 bits, RGB
    return "\x89PNG\r\n\x1a\n" + chunk("IHDR", head) +
           chunk("IDAT", up.size() < plain.size() ? up : plain) + chunk("IEND", "");
}

std::string address(const Picture& picture) {
    return "data:image/png;base64," + base64(png(picture));
}

Picture shrunk(std::string_view pixels, std::uint32_t width, std::uint32_t height,
               std::uint32_t channels, std::uint32_t most) {
    const std::uint32_t factor = (std::max(width, height) + most - 1) / most;
    Picture result{std::max(width / factor, 1U), std::max(height / factor, 1U), ""};
    for (std::size_t y = 0; y < result.height; ++y)
        for (std::size_t x = 0; x < result.width; ++x)
            for (std::size_t c = 0; c < 3; ++c) {
                std::uint32_t sum = 0;
                std::uint32_t count = 0;
                for (std::size_t v = y * factor;
                     v < std::min<std::size_t>((y + 1) * factor, height); ++v)
                    for (std::size_t u = x * factor;
                         u < std::min<std::size_t>((x + 1) * factor, width); ++u) {
                        const std::size_t channel = channels == 1 ? 0 : c;
                        sum +=
                            static_cast<std::uint8_t>(pixels[(v * width + u) * channels + channel]);
                        ++count;
                    }
                result.pixels += static_cast<char>(sum / std::max(count, 1U));
            }
    return result;
}

}  // namespace etlc::report
