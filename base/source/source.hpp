// Holds the text of one input file and maps byte offsets to lines and columns. Every offset in [0,
// size] has a position; lines end at
//  or \r
// ; columns count code points from 1.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace etlc::source {

/// A half-open byte range [begin, end) of a file.
struct Span {
    std::uint32_t begin = 0;
    std::uint32_t end = 0;

    bool operator==(const Span&) const = default;
};

/// Returns the smallest span that covers both.
Span join(Span a, Span b);

/// Line and column, both from 1, as editors show them.
struct Position {
    std::uint32_t line = 1;
    std::uint32_t column = 1;
};

class File {
public:
    File() = default;
    File(std::string path, std::string text);

    const std::string& path() const { return path_; }
    std::string_view text() const { return text_; }
    std::string_view text(Span span) const;

    Position position(std::uint32_t offset) const;
    std::uint32_t line_count() const { return static_cast<std::uint32_t>(line_begins_.size()); }
    /// Returns line `line` (from 1) without its line end.
    std::string_view line_text(std::uint32_t line) const;
    std::uint32_t line_begin(std::uint32_t line) const { return line_begins_[line - 1]; }

private:
    std::uint32_t code_points_before(std::uint32_t offset) const;

    std::string path_;
    std::string text_;
    std::vector<std::uint32_t> line_begins_{0};
    std::vector<std::uint32_t> code_points_before_{
        0};  ///< entry i counts those in the first i blocks of 1024 bytes
};

}  // namespace etlc::source
