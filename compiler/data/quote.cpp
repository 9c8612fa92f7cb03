#include "data/quote.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

namespace etlc::data {
namespace {

constexpr std::size_t kMaxQuoted = 60;  ///< bytes
constexpr std::size_t kMaxListed = 10;

/// Bytes of the well-formed UTF-8 character that `text` begins with; 0 where there is none.
std::size_t character(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    std::size_t length = 0;
    if (byte(0) < 0x80)
        length = 1;
    else if (byte(0) >= 0xc2 && byte(0) < 0xe0)
        length = 2;
    else if (byte(0) >= 0xe0 && byte(0) < 0xf0)
        length = 3;
    else if (byte(0) >= 0xf0 && byte(0) < 0xf5)
        length = 4;
    if (length == 0 || text.size() < length) return 0;
    for (std::size_t i = 1; i < length; ++i)
        if ((byte(i) & 0xc0U) != 0x80U) return 0;
    const bool overlong = (byte(0) == 0xe0 && byte(1) < 0xa0) || (byte(0) == 0xf0 && byte(1) < 0x90);
    const bool surrogate_or_beyond = (byte(0) == 0xed && byte(1) >= 0xa0) || (byte(0) == 0xf4 && byte(1) >= 0x90);
    const bool control = byte(0) == 0xc2 && byte(1) < 0xa0;  // the C1 controls
    return overlong || surrogate_or_beyond || control ? 0 : length;
}

}  // namespace

std::string in_quotes(std::string_view text) {
    std::string result = "'";
    std::size_t i = 0;
    while (i < text.size() && i < kMaxQuoted) {
        const std::size_t length = character(text.substr(i));
        const auto byte = static_cast<unsigned char>(text[i]);
        if (length == 0 || byte < 0x20 || byte == 0x7f) {
            result += fmt::format("\\x{:02x}", byte);
            ++i;
        } else {
            result += text.substr(i, length);
            i += length;
        }
    }
    if (i < text.size()) result += "...";
    return result + "'";
}

std::string listed(const std::vector<std::string>& names) {
    std::string result;
    const std::size_t shown = std::min(names.size(), kMaxListed);
    const std::size_t hidden = names.size() - shown;
    for (std::size_t i = 0; i < shown; ++i) {
        if (i > 0) result += i + 1 == shown && hidden == 0 ? " and " : ", ";
        result += in_quotes(names[i]);
    }
    if (hidden > 0) result += fmt::format(" and {} more", hidden);
    return result;
}

}  // namespace etlc::data
