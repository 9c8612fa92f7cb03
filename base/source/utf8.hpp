// Whether bytes are text.
// Takes: bytes. Gives: characters after RFC 3629 (no overlong forms, surrogates or values above
// U+10FFFF).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

namespace etlc::source {

inline constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// The length of the character that begins `text`; 0 where its bytes are not UTF-8, or `text` is
/// empty.
std::size_t utf8_length(std::string_view text);

/// Whether the byte continues a character that an earlier one began.
constexpr bool is_continuation(char byte) {
    return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U;
}

/// The offset of the first byte that is not UTF-8; the size of `text` where there is none.
std::size_t first_invalid_utf8(std::string_view text);

/// The character that these bytes are, as utf8_length() found them.
char32_t code_point(std::string_view character);

struct CodePoints {
    char32_t first;
    char32_t last;
};

template <std::size_t N>
constexpr bool is_in(const std::array<CodePoints, N>& ranges, char32_t character) {
    return std::any_of(ranges.begin(), ranges.end(), [character](CodePoints r) {
        return r.first <= character && character <= r.last;
    });
}

/// Whether a reader would not see the character, or see others in another order: controls, blanks
/// of no width, what turns the direction of writing (Trojan Source, CVE-2021-42574), line
/// separators. Tabs and line ends are.
bool is_hidden(char32_t character);

}  // namespace etlc::source
