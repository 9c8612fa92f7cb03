#include "png.hpp"

#include <cstdint>
#include <string_view>

namespace demo {
namespace {

std::string big_endian(std::uint32_t value) {
    std::string bytes;
    for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 0xffU);
    return bytes;
}

std::uint32_t crc32(std::string_view bytes) {
    std::uint32_t crc = 0xffffffffU;
    for (const char c : bytes) {
        crc ^= static_cast<std::uint8_t>(c);
        for (int bit = 0; bit < 8; ++bit) crc = crc >> 1U ^ (crc & 1U ? 0xedb88320U : 0U);
    }
    return ~crc;
}

std::uint32_t adler32(std::string_view bytes) {
    std::uint32_t a = 1;
    std::uint32_t b = 0;
    for (const char c : bytes) {
        a = (a + static_cast<std::uint8_t>(c)) % 65521;
        b = (b + a) % 65521;
    }
    return b << 16U | a;
}

std::string chunk(const std::string& name_and_data) {
    return big_endian(static_cast<std::uint32_t>(name_and_data.size() - 4)) + name_and_data +
           big_endian(crc32(name_and_data));
}

/// The whole image fits one stored block (at most 65535 bytes).
std::string zlib_stored(const std::string& data) {
    const auto size = static_cast<std::uint16_t>(data.size());
    std::string stream = "\x78\x01\x01";  // zlib header; last block, stored
    for (const unsigned half : {unsigned{size}, ~unsigned{size}}) {
        stream += static_cast<char>(half & 0xffU);
        stream += static_cast<char>(half >> 8U & 0xffU);
    }
    return stream + data + big_endian(adler32(data));
}

std::string base64(std::string_view bytes) {
    constexpr std::string_view kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t triple = 0;
        for (std::size_t j = 0; j < 3; ++j) {
            triple = triple << 8U |
                     (i + j < bytes.size() ? static_cast<std::uint8_t>(bytes[i + j]) : 0U);
        }
        for (std::size_t j = 0; j < 4; ++j) {
            text += i + j > bytes.size() ? '=' : kDigits[triple >> (18 - 6 * j) & 63U];
        }
    }
    return text;
}

}  // namespace

std::string png_address(const Image& image) {
    std::string rows;
    for (int row = 0; row < kImageSide; ++row) {
        rows += '\0';  // no filter
        rows.append(reinterpret_cast<const char*>(image.data()) + row * kImageSide, kImageSide);
    }
    const std::string size = big_endian(kImageSide);
    const std::string grey_8_bit{'\x08', '\0', '\0', '\0', '\0'};
    const std::string file = "\x89PNG\r\n\x1a\n" + chunk("IHDR" + size + size + grey_8_bit) +
                             chunk("IDAT" + zlib_stored(rows)) + chunk("IEND");
    return "data:image/png;base64," + base64(file);
}

}  // namespace demo
