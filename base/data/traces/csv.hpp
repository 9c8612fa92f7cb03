// Rows of a .csv file, one at a time: RFC 4180, with LF or CRLF line ends, and as Excel writes it:
// with a byte order mark, in UTF-16, with a first line sep=; or with semicolons or tabs in a header
// without commas, and, between semicolons, with decimal commas. Takes: a stream of bytes. Gives:
// the cells of a row with their line and column. Blanks around unquoted cells are dropped. Keeps
// true: memory is one row, at most kMaxRowBytes; nothing is guessed: a stray quote or a lone CR is
// an error, and so are decimal points beside decimal commas.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "data/files/file.hpp"
#include "diag/diag.hpp"

namespace etlc::data {

/// The largest row, without its line end.
inline constexpr std::size_t kMaxRowBytes = 4U << 20U;

/// Says that a row and the header have other numbers of cells.
std::string other_cells(std::size_t row, std::size_t header);

class CsvReader {
public:
    explicit CsvReader(std::unique_ptr<ByteSource> source);

    /// Reads the next row; false at the end of the file. An empty line is a row of one empty cell.
    diag::Result<bool> next();

    std::size_t cells() const { return cells_.size(); }
    std::string_view cell(std::size_t i) const;
    bool empty(std::size_t i) const { return cells_[i].begin == cells_[i].end; }
    /// Returns whether all cells are empty, as of rows that were cleared in a spreadsheet.
    bool empty() const;
    /// Parses a cell, as parse_number does; a comma is the decimal point where semicolons separate.
    std::optional<double> number(std::size_t i);
    /// Says what a cell that is no number would have to be: "a number", or how to write one.
    std::string expected_number(std::size_t i) const;
    /// The place where cell `i` begins, from 1; columns count code points.
    std::uint32_t line(std::size_t i) const { return cells_[i].line; }
    std::uint32_t column(std::size_t i) const { return cells_[i].column; }
    /// The line that the row begins on.
    std::uint32_t row_line() const { return row_line_; }

private:
    struct Cell {
        std::size_t begin = 0;  ///< in row_
        std::size_t end = 0;
        std::uint32_t line = 1;
        std::uint32_t column = 1;
    };
    static constexpr int kEnd = -1;
    static constexpr int kError = -2;

    /// Returns the next byte without consuming it; kEnd at the end, kError where the source failed.
    int peek() { return at_ < filled_ ? static_cast<unsigned char>(buffer_[at_]) : peek_further(); }
    int peek_further();
    void advance();
    bool take_line_end();
    void read_cell();
    void read_quoted();
    void read_plain();
    /// Cells count as well as bytes, since a row of commas holds no text.
    void check_length() {
        if (row_.size() + cells_.size() > kMaxRowBytes) fail_length();
    }
    void fail_length();
    void begin();
    bool fill();
    void fail(std::string message, std::uint32_t line, std::uint32_t column);

    std::unique_ptr<ByteSource> source_;
    std::array<char, 1U << 16U> buffer_;
    std::size_t at_ = 0;
    std::size_t filled_ = 0;
    std::uint32_t line_ = 1;
    std::uint32_t column_ = 1;
    std::string row_;
    std::vector<Cell> cells_;
    std::uint32_t row_line_ = 1;
    bool started_ = false;
    char separator_ = ',';
    bool has_points_ = false;  ///< where semicolons separate, some number has a decimal point
    bool has_commas_ = false;  ///< a decimal comma
    std::optional<diag::Failure> failure_;
};

}  // namespace etlc::data
