// UTF-8, and text from outside as it is printed.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace etlc::source {

// Escapes text from outside (file names, words of the spec, of data and of thresholds) for what it
// is printed to, so that it cannot break out of its place and a reader sees what it is. All such
// text is printed through these functions; plain words stay as they are.

/// Escapes for terminals and messages, in one line: hidden characters (is_hidden) become \u{202E},
/// control bytes and bytes that are not UTF-8 become \x1b.
std::string visible(std::string_view text);

/// Escapes a report of many lines in the same way; line ends stay.
std::string visible_lines(std::string_view text);

/// Escapes text at the end of a comment in generated code, so that the next line does not belong to
/// it.
std::string code_line(std::string_view text);

/// Returns the text as a JSON string in quotes; bytes that are not UTF-8 become U+FFFD.
std::string json_string(std::string_view text);

/// Returns the text as a cell of a CSV row, in quotes where necessary.
std::string csv_cell(std::string_view text);

/// Returns the text as a DOT string in quotes.
std::string dot_string(std::string_view text);

/// Escapes a path for a dependency file that make and ninja both read; nothing where one of them
/// cannot (each accepts names that the other does not).
enum class InRule { target, prerequisite };
std::optional<std::string> depfile_path(std::string_view path, InRule place);

// Splits bytes into characters after RFC 3629 (no overlong forms, surrogates or values above
// U+10FFFF).

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
