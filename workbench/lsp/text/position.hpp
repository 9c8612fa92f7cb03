// Converts byte offsets of UTF-8 text to the protocol's lines and characters, and back.
// Keeps true: lines end at \n, \r\n or \r; a character is a UTF-16 unit, or a byte where the client
// agreed to that; every position has an offset: a position beyond a line maps to its end, one
// beyond the text to the end of the text, one inside a character to its beginning.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "source/source.hpp"

namespace etlc::lsp {

enum class Encoding : std::uint8_t { utf16, utf8 };

struct Position {
    std::uint32_t line = 0;
    std::uint32_t character = 0;

    auto operator<=>(const Position&) const = default;
};

struct Range {
    Position start;
    Position end;

    bool operator==(const Range&) const = default;
};

/// The lines of a text, which must outlive them.
class Lines {
public:
    Lines(std::string_view text, Encoding encoding);

    std::size_t count() const { return begins_.size(); }
    std::uint32_t offset(Position position) const;
    Position position(std::uint32_t offset) const;
    Range range(source::Span span) const { return {position(span.begin), position(span.end)}; }
    source::Span span(Range range) const { return {offset(range.start), offset(range.end)}; }

private:
    /// Returns the end of a line, before its line break.
    std::uint32_t end_of(std::size_t line) const;

    std::string_view text_;
    Encoding encoding_;
    std::vector<std::uint32_t> begins_{0};
};

}  // namespace etlc::lsp
