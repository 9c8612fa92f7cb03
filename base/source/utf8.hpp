// Whether bytes are text.
// Takes: bytes. Gives: characters after RFC 3629 (no overlong forms, surrogates or values above
// U+10FFFF).
#pragma once

#include <cstddef>
#include <string_view>

namespace etlc::source {

inline constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// The length of the character that begins `text`; 0 where its bytes are not UTF-8, or `text` is
/// empty.
std::size_t utf8_length(std::string_view text);

/// The offset of the first byte that is not UTF-8; the size of `text` where there is none.
std::size_t first_invalid_utf8(std::string_view text);

/// The character that these bytes are, as utf8_length() found them.
char32_t code_point(std::string_view character);

/// Whether a reader would not see the character, or see others in another order: controls, blanks
/// of no width, what turns the direction of writing (Trojan Source, CVE-2021-42574), line
/// separators. Tabs and line ends are.
bool is_hidden(char32_t character);

}  // namespace etlc::source
