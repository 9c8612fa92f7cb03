// Whether bytes are text.
// Takes: bytes. Gives: the lengths of characters after RFC 3629 (no overlong forms, surrogates or values above
// U+10FFFF).
#pragma once

#include <cstddef>
#include <string_view>

namespace etlc::parse {

inline constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// The length of the character that begins `text`; 0 where its bytes are not UTF-8, or `text` is empty.
std::size_t utf8_length(std::string_view text);

/// The offset of the first byte that is not UTF-8; the size of `text` where there is none.
std::size_t first_invalid_utf8(std::string_view text);

}  // namespace etlc::parse
