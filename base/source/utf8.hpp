// Splits bytes into characters after RFC 3629 (no overlong forms, surrogates or values above
// U+10FFFF).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

namespace etlc::source {

inline constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// Returns the length of the character that begins `text`; 0 where its bytes are not UTF-8 or
/// `text` is empty.
std::size_t utf8_length(std::string_view text);

/// Whether the byte continues a character that an earlier byte began.
constexpr bool is_continuation(char byte) {
    return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U;
}

/// Returns the offset of the first byte that is not UTF-8, or the size of `text`.
std::size_t first_invalid_utf8(std::string_view text);

/// Decodes a character of the length that utf8_length() returned.
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

/// Whether readers would not see the character, or would see others in another order: controls,
/// zero-width characters, changes of the writing direction (Trojan Source, CVE-2021-42574) and line
/// separators. Tabs and line ends count as hidden.
bool is_hidden(char32_t character);

}  // namespace etlc::source
