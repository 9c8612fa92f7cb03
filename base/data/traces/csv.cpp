#include "data/traces/csv.hpp"

#include <fmt/format.h>

#include "data/text/quote.hpp"

namespace etlc::data {

using diag::Code;
using diag::Failure;

namespace {

/// Returns 1 for a byte that begins a UTF-8 character, 0 for one within it.
std::uint32_t begins_character(char c) {
    return (static_cast<unsigned char>(c) & 0xc0U) != 0x80U ? 1 : 0;
}

/// The bytes that end a cell without quotes are below those of numbers and letters.
bool ends_plain(char c) {
    return static_cast<unsigned char>(c) <= ',' && (c == ',' || c == '\n' || c == '\r' || c == '"');
}

}  // namespace

CsvReader::CsvReader(std::unique_ptr<ByteSource> source) : source_(std::move(source)) {}

std::string_view CsvReader::cell(std::size_t i) const {
    return std::string_view(row_).substr(cells_[i].begin, cells_[i].end - cells_[i].begin);
}

diag::Result<bool> CsvReader::next() {
    if (!started_) skip_byte_order_mark();
    started_ = true;
    row_.clear();
    cells_.clear();
    row_line_ = line_;
    if (!failure_ && peek() == kEnd) return false;
    while (!failure_) {
        read_cell();
        check_length();
        if (failure_ || take_line_end()) break;
        advance();  // the comma
    }
    if (failure_) return *failure_;
    return true;
}

int CsvReader::peek_further() {
    if (failure_) return kError;
    const auto got = source_->read(buffer_.data(), buffer_.size());
    if (!got) {
        failure_ = got.failure();
        return kError;
    }
    at_ = 0;
    filled_ = *got;
    return filled_ == 0 ? kEnd : static_cast<unsigned char>(buffer_[0]);
}

void CsvReader::advance() {
    const char c = buffer_[at_++];
    if (c == '\n') {
        ++line_;
        column_ = 1;
    } else {
        column_ += begins_character(c);
    }
}

/// Consumes the line end and returns true at the end of a row; returns false before a comma.
bool CsvReader::take_line_end() {
    const int c = peek();
    if (c == kEnd || c == kError) return true;
    if (c == ',') return false;
    if (c == '\r') {
        const std::uint32_t column = column_;
        advance();
        if (peek() != '\n') fail("carriage return without a line feed", line_, column);
    }
    if (peek() == '\n') advance();
    return true;
}

void CsvReader::read_cell() {
    cells_.push_back({row_.size(), row_.size(), line_, column_});
    if (peek() == '"')
        read_quoted();
    else
        read_plain();
}

void CsvReader::read_quoted() {
    Cell& cell = cells_.back();
    advance();
    for (;;) {
        const int c = peek();
        if (c == kError) return;
        if (c == kEnd)
            return fail("quote that is not closed before the end of the file", cell.line,
                        cell.column);
        advance();
        if (c == '"') {
            if (peek() != '"') break;
            advance();
        }
        row_.push_back(static_cast<char>(c));
        check_length();
        if (failure_) return;
    }
    cell.end = row_.size();
    const int c = peek();
    if (c != ',' && c != '\r' && c != '\n' && c >= 0) {
        const char byte = static_cast<char>(c);
        fail(fmt::format("{} after a closing quote, expected a comma or the end of the line",
                         in_quotes({&byte, 1})),
             line_, column_);
    }
}

void CsvReader::read_plain() {
    Cell& cell = cells_.back();
    while (peek() >= 0) {
        const char* const begin = buffer_.data() + at_;
        const char* const filled = buffer_.data() + filled_;
        const char* end = begin;
        for (; end != filled && !ends_plain(*end); ++end) column_ += begins_character(*end);
        row_.append(begin, end);
        at_ += static_cast<std::size_t>(end - begin);
        if (end != filled) break;
        check_length();
        if (failure_) return;
    }
    if (peek() == '"')
        return fail("quote within a cell that does not begin with one", line_, column_);
    const auto blank = [&](std::size_t i) { return row_[i] == ' ' || row_[i] == '\t'; };
    cell.end = row_.size();
    while (cell.begin < cell.end && blank(cell.begin)) {
        ++cell.begin;
        ++cell.column;
    }
    while (cell.begin < cell.end && blank(cell.end - 1)) --cell.end;
}

void CsvReader::fail_length() {
    fail(fmt::format("row is longer than {} bytes, the most that is read", kMaxRowBytes), row_line_,
         1);
}

void CsvReader::skip_byte_order_mark() {
    const int first = peek();
    if ((first == 0xff || first == 0xfe) && filled_ >= 2 &&
        static_cast<unsigned char>(buffer_[1]) == (first == 0xff ? 0xfe : 0xff))
        return fail("is UTF-16, expected UTF-8", 0, 0);
    if (filled_ >= 3 && std::string_view(buffer_.data(), 3) == "\xef\xbb\xbf") at_ = 3;
}

void CsvReader::fail(std::string message, std::uint32_t line, std::uint32_t column) {
    if (!failure_) failure_ = Failure{Code::malformed_csv, std::move(message), line, column};
}

}  // namespace etlc::data
