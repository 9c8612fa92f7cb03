// Pictures of 8-bit RGB as PNG (ISO/IEC 15948), by zlib.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace etlc::report {

struct Picture {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::string pixels;  ///< rows from the top, red, green, blue
};

std::string png(const Picture& picture);
/// The same as a data: address.
std::string address(const Picture& picture);

inline constexpr std::uint32_t kMostPixels = 96;  ///< of a side of what the page shows

/// No wider or higher than this, by the mean of the pixels that fall into one.
Picture shrunk(std::string_view pixels, std::uint32_t width, std::uint32_t height,
               std::uint32_t channels, std::uint32_t most);

}  // namespace etlc::report
