#include "diag/source_view.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "source/utf8.hpp"

namespace etlc::diag {

namespace {

/// Columns shown of a line that is longer than this.
constexpr std::size_t kWindow = 120;
constexpr std::size_t kContextBefore = 40;
constexpr std::string_view kReplacement = "\xEF\xBF\xBD";
constexpr std::string_view kEllipsis = "...";

/// One character of a line: its bytes, and the columns it takes.
struct Cell {
    std::string_view bytes;
    std::size_t offset;  ///< in the line
    std::uint8_t width;
};

struct CodePointRange {
    char32_t first;
    char32_t last;
};

template <std::size_t N>
bool is_in(const std::array<CodePointRange, N>& ranges, char32_t c) {
    return std::any_of(ranges.begin(), ranges.end(),
                       [c](CodePointRange r) { return r.first <= c && c <= r.last; });
}

/// Columns of a code point, after Unicode's East Asian Width and general categories Mn and Cf, by
/// their main blocks.
std::uint8_t width_of(char32_t c) {
    static constexpr std::array<CodePointRange, 8> kZero{{{0x300, 0x36F},
                                                          {0x483, 0x489},
                                                          {0x591, 0x5BD},
                                                          {0x610, 0x61A},
                                                          {0x64B, 0x65F},
                                                          {0x200B, 0x200F},
                                                          {0x20D0, 0x20FF},
                                                          {0xFE00, 0xFE0F}}};
    static constexpr std::array<CodePointRange, 10> kWide{{{0x1100, 0x115F},
                                                           {0x2E80, 0x303E},
                                                           {0x3041, 0x33FF},
                                                           {0x3400, 0x4DBF},
                                                           {0x4E00, 0x9FFF},
                                                           {0xA000, 0xA4CF},
                                                           {0xAC00, 0xD7A3},
                                                           {0xF900, 0xFAFF},
                                                           {0xFF00, 0xFF60},
                                                           {0x1F300, 0x1FAFF}}};
    if (is_in(kZero, c)) return 0;
    return is_in(kWide, c) || (c >= 0x20000 && c <= 0x3FFFD) ? 2 : 1;
}

std::vector<Cell> cells_of(std::string_view line, std::size_t offset) {
    std::vector<Cell> cells;
    for (std::size_t i = 0; i < line.size();) {
        const std::size_t length = source::utf8_length(line.substr(i));
        const std::string_view bytes = line.substr(i, length == 0 ? 1 : length);
        const char32_t value = length == 0 ? U'\0' : source::code_point(bytes);
        const bool shown = value == U'\t' || !source::is_hidden(value);
        cells.push_back(
            {shown ? bytes : kReplacement, offset + i, shown ? width_of(value) : std::uint8_t{1}});
        i += bytes.size();
    }
    return cells;
}

/// The part of a long line that is decoded at all: a line may have megabytes.
struct Part {
    std::size_t begin;
    std::size_t end;
};

bool is_continuation(char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;
}

/// Moves back to the first byte of a character; at most three bytes, since the text need not be
/// UTF-8.
std::size_t character_begin(std::string_view line, std::size_t at) {
    for (int i = 0; i < 3 && at > 0 && at < line.size() && is_continuation(line[at]); ++i) --at;
    return at;
}

Part part_around(std::string_view line, std::size_t at) {
    if (line.size() <= kWindow) return {0, line.size()};
    const std::size_t end_at_most = line.size() - kWindow;
    const std::size_t begin =
        character_begin(line, std::min(at > kContextBefore ? at - kContextBefore : 0, end_at_most));
    return {begin, character_begin(line, std::min(line.size(), begin + kWindow))};
}

}  // namespace

SourceView view(const source::File& file, source::Span span) {
    const std::uint32_t line_number = file.position(span.begin).line;
    const std::string_view line = file.line_text(line_number);
    const std::size_t begin =
        std::min<std::size_t>(span.begin - file.line_begin(line_number), line.size());
    const std::size_t past = std::max(span.begin, span.end) - file.line_begin(line_number);
    const std::size_t end =
        std::clamp<std::size_t>(past, begin, line.size());  // a span of many lines: the first

    const Part part = part_around(line, begin);
    SourceView result;
    if (part.begin > 0) result = {std::string(kEllipsis), std::string(kEllipsis.size(), ' ')};
    bool started = false;
    for (const Cell& cell : cells_of(line.substr(part.begin, part.end - part.begin), part.begin)) {
        result.text += cell.bytes;
        if (cell.offset < begin) {
            result.carets += cell.bytes == "\t" ? std::string("\t") : std::string(cell.width, ' ');
        } else if (!started || cell.offset < end) {
            const std::size_t width = std::max<std::size_t>(cell.width, 1);
            result.carets += std::string(width, '~');
            if (!started) result.carets[result.carets.size() - width] = '^';
            started = true;
        }
    }
    if (!started) result.carets += '^';  // just after the line's last character
    if (part.end < line.size()) result.text += kEllipsis;
    return result;
}

}  // namespace etlc::diag
