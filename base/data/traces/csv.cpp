#include "data/traces/csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "data/text/text.hpp"
#include "data/traces/trace_formats.hpp"
#include "source/text.hpp"

namespace etlc::data {

using diag::Code;
using diag::Failure;

namespace {

/// The bytes that end a cell without quotes are below those of numbers and letters, but for `;`.
bool ends_plain(char c, char separator) {
    return static_cast<unsigned char>(c) <= ';' &&
           (c == separator || c == '\n' || c == '\r' || c == '"');
}

/// Returns what separates the cells of a header: commas if it has any, else semicolons or tabs.
char separator_of(std::string_view header) {
    std::string plain;
    bool is_quoted = false;
    for (const char c : header) {
        if (c == '"') is_quoted = !is_quoted;
        if (!is_quoted) plain += c;
    }
    for (const char c : {',', ';', '\t'})
        if (plain.find(c) != std::string::npos) return c;
    return ',';
}

/// UTF-8 of a source in UTF-16.
class Utf16 final : public ByteSource {
public:
    /// `begin`: bytes of the source that were read before.
    Utf16(std::unique_ptr<ByteSource> source, std::string begin, bool is_little)
        : source_(std::move(source)), units_(std::move(begin)), is_little_(is_little) {}

    diag::Result<std::size_t> read(char* to, std::size_t n) override {
        while (text_.size() < n && !is_over_) {
            char bytes[4096];
            const auto got = source_->read(bytes, sizeof bytes);
            if (!got) return got.failure();
            units_.append(bytes, *got);
            is_over_ = *got == 0;
            if (!decode())
                return Failure{Code::malformed_csv, "is UTF-16 that is damaged: save it as UTF-8"};
            if (*got < sizeof bytes && !text_.empty()) break;  // a pipe has no more now
        }
        n = std::min(n, text_.size());
        std::copy_n(text_.data(), n, to);
        text_.erase(0, n);
        return n;
    }

    std::uint64_t size() const override { return source_->size(); }

private:
    unsigned unit(std::size_t at) const {
        const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(units_[i]); };
        return byte(at + (is_little_ ? 1 : 0)) * 256U + byte(at + (is_little_ ? 0 : 1));
    }

    /// Decodes all characters that are complete; false where one is not, at the end, or is none.
    bool decode() {
        std::size_t at = 0;
        while (at + 2 <= units_.size()) {
            unsigned long code = unit(at);
            const bool is_first = code >= 0xd800 && code < 0xdc00;
            if (code >= 0xdc00 && code < 0xe000) return false;
            if (is_first && at + 4 > units_.size()) break;
            if (is_first) {
                const unsigned second = unit(at + 2);
                if (second < 0xdc00 || second >= 0xe000) return false;
                code = 0x10000 + (code - 0xd800) * 0x400 + (second - 0xdc00);
            }
            append(code);
            at += is_first ? 4 : 2;
        }
        units_.erase(0, at);
        return !is_over_ || units_.empty();
    }

    void append(unsigned long code) {
        const auto add = [&](unsigned long byte) { text_ += static_cast<char>(byte); };
        if (code < 0x80) return add(code);
        if (code < 0x800) {
            add(0xc0 + code / 0x40);
        } else {
            if (code < 0x10000) add(0xe0 + code / 0x1000);
            if (code >= 0x10000) add(0xf0 + code / 0x40000);
            if (code >= 0x10000) add(0x80 + code / 0x1000 % 0x40);
            add(0x80 + code / 0x40 % 0x40);
        }
        add(0x80 + code % 0x40);
    }

    std::unique_ptr<ByteSource> source_;
    std::string units_;  ///< not yet decoded
    std::string text_;
    bool is_little_;
    bool is_over_ = false;
};

}  // namespace

std::string other_cells(std::size_t row, std::size_t header) {
    return fmt::format(
        "row has {}, the header has {}{}", diag::counted(row, "cell"), header,
        row > header ? "; where a comma is the decimal point, semicolons separate cells" : "");
}

CsvReader::CsvReader(std::unique_ptr<ByteSource> source) : source_(std::move(source)) {}

std::string_view CsvReader::cell(std::size_t i) const {
    return std::string_view(row_).substr(cells_[i].begin, cells_[i].end - cells_[i].begin);
}

diag::Result<bool> CsvReader::next() {
    if (!std::exchange(started_, true)) begin();
    row_.clear();
    cells_.clear();
    row_line_ = line_;
    if (!failure_ && peek() == kEnd) return false;
    while (!failure_) {
        read_cell();
        check_length();
        if (failure_ || take_line_end()) break;
        advance();  // the separator
    }
    if (failure_) return *failure_;
    return true;
}

int CsvReader::peek_further() {
    if (failure_) return kError;
    at_ = filled_ = 0;
    if (fill()) return static_cast<unsigned char>(buffer_[0]);
    return failure_ ? kError : kEnd;
}

void CsvReader::advance() {
    const char c = buffer_[at_++];
    if (c == '\n') {
        ++line_;
        column_ = 1;
    } else {
        column_ += source::is_continuation(c) ? 0 : 1;
    }
}

/// Consumes the line end and returns true at the end of a row; returns false before a separator.
bool CsvReader::take_line_end() {
    const int c = peek();
    if (c == kEnd || c == kError) return true;
    if (c == separator_) return false;
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
    if (c != separator_ && c != '\r' && c != '\n' && c >= 0) {
        const char byte = static_cast<char>(c);
        fail(fmt::format("{} after a closing quote, expected {} or the end of the line",
                         in_quotes({&byte, 1}),
                         separator_ == ','   ? "a comma"
                         : separator_ == ';' ? "a semicolon"
                                             : "a tab"),
             line_, column_);
    }
}

void CsvReader::read_plain() {
    Cell& cell = cells_.back();
    while (peek() >= 0) {
        const char* const begin = buffer_.data() + at_;
        const char* const filled = buffer_.data() + filled_;
        const char* end = begin;
        for (; end != filled && !ends_plain(*end, separator_); ++end)
            column_ += source::is_continuation(*end) ? 0 : 1;
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

/// Reads more into the buffer; false at the end, and where the buffer is full.
bool CsvReader::fill() {
    if (failure_ || filled_ == buffer_.size()) return false;
    const auto got = source_->read(buffer_.data() + filled_, buffer_.size() - filled_);
    if (!got) failure_ = got.failure();
    if (got) filled_ += *got;
    return got && *got > 0;
}

/// Looks at the first line, for how the file is written.
void CsvReader::begin() {
    const auto bytes = [&] { return std::string_view(buffer_.data(), filled_); };
    while (filled_ < 2 && fill()) {
    }
    const bool is_little = bytes().starts_with("\xff\xfe");
    if (is_little || bytes().starts_with("\xfe\xff")) {
        source_ =
            std::make_unique<Utf16>(std::move(source_), std::string(bytes().substr(2)), is_little);
        filled_ = 0;
    }
    while (bytes().find('\n') == std::string_view::npos && fill()) {
    }
    if (bytes().starts_with("\xef\xbb\xbf")) at_ = 3;
    const std::string_view rest = bytes().substr(at_);
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    std::string_view line = rest.substr(0, end);
    if (line.ends_with('\r')) line.remove_suffix(1);
    constexpr std::string_view kSeparator = "sep=";
    const bool is_said = line.size() == 5 && line.starts_with(kSeparator) &&
                         std::string_view(",;\t").find(line[4]) != std::string_view::npos;
    separator_ = is_said ? line[4] : separator_of(line);
    if (!is_said) return;
    at_ += std::min(end + 1, rest.size());
    line_ = 2;
}

bool CsvReader::empty() const {
    return std::all_of(cells_.begin(), cells_.end(),
                       [](const Cell& cell) { return cell.begin == cell.end; });
}

std::optional<double> CsvReader::number(std::size_t i) {
    const std::string_view text = cell(i);
    if (separator_ != ';') return parse_number(text);
    const std::size_t comma = text.find(',');
    const bool has_comma = comma != std::string_view::npos;
    const bool has_point = text.find('.') != std::string_view::npos;
    if (has_comma ? has_point || has_points_ : has_point && has_commas_) return std::nullopt;
    has_commas_ = has_commas_ || has_comma;
    has_points_ = has_points_ || has_point;
    if (!has_comma) return parse_number(text);
    std::string decimal(text);
    decimal[comma] = '.';
    return parse_number(decimal);
}

std::string CsvReader::expected_number(std::size_t i) const {
    const bool has_comma = cell(i).find(',') != std::string_view::npos;
    const bool has_point = cell(i).find('.') != std::string_view::npos;
    if (has_comma && (separator_ != ';' || has_points_))
        return "a number with a decimal point" +
               std::string(separator_ == ';' ? ", as before it" : "");
    if (has_point && has_commas_) return "a number with a decimal comma, as before it";
    return "a number";
}

void CsvReader::fail(std::string message, std::uint32_t line, std::uint32_t column) {
    if (!failure_) failure_ = Failure{Code::malformed_csv, std::move(message), line, column};
}

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kCandidates =
    1000;  ///< for a suggested name: an edit distance is computed to each

/// A column of the file and the element of a channel that it feeds.
struct Slot {
    std::size_t column = 0;
    std::size_t channel = 0;
    std::size_t element = 0;
};

std::string column_name(const Channel& channel, std::size_t element) {
    return channel.kind == Channel::Kind::vector ? fmt::format("{}[{}]", channel.name, element)
                                                 : channel.name;
}

/// The columns of a header by name, with the number of columns of each name.
class Header {
public:
    explicit Header(const CsvReader& row) {
        for (std::size_t i = 0; i < row.cells(); ++i) {
            names_.emplace_back(row.cell(i));
            auto& entry = columns_[names_.back()];
            entry.column = entry.count == 0 ? i : entry.column;
            ++entry.count;
        }
    }

    /// Returns the columns of all elements of all channels, in their order in the file.
    diag::Result<std::vector<Slot>> slots(const std::vector<Channel>& channels) const {
        std::vector<Slot> result;
        for (std::size_t c = 0; c < channels.size(); ++c) {
            if (channels[c].optional && !columns_.contains(column_name(channels[c], 0))) continue;
            for (std::size_t e = 0; e < channels[c].width; ++e) {
                const std::string name = column_name(channels[c], e);
                const auto found = columns_.find(name);
                if (found == columns_.end()) return absent(name, channels[c]);
                if (found->second.count > 1 && are_times(channels[c])) continue;
                if (found->second.count > 1)
                    return Failure{Code::no_such_channel,
                                   fmt::format("{} columns are named {}", found->second.count,
                                               in_quotes(name)),
                                   1, 1};
                result.push_back({found->second.column, c, e});
            }
            if (auto failure = beyond(channels[c])) return *failure;
        }
        std::sort(result.begin(), result.end(),
                  [](const Slot& a, const Slot& b) { return a.column < b.column; });
        return result;
    }

private:
    struct Entry {
        std::size_t column = 0;
        std::size_t count = 0;
    };

    Failure absent(const std::string& name, const Channel& channel) const {
        std::string message = fmt::format("no column {}", in_quotes(name));
        const bool vector = channel.kind == Channel::Kind::vector;
        if (vector)
            message +=
                fmt::format(", needed by input '{}' of {} elements", channel.name, channel.width);
        std::vector<std::string> candidates = names_;
        candidates.resize(std::min(candidates.size(), kCandidates));
        // z[15] is no misspelling of z[16]: a shorter vector gets no suggestion.
        const bool shorter = vector && columns_.contains(column_name(channel, 0));
        const std::string meant = shorter ? "" : suggestion(name, candidates);
        message += meant.empty() ? "; there are " + listed(names_) : meant;
        return {Code::no_such_channel, message, 1, 1};
    }

    /// Refuses a column beyond the width of a vector: the file was made for another width.
    std::optional<Failure> beyond(const Channel& channel) const {
        if (channel.kind != Channel::Kind::vector) return {};
        const std::string next = column_name(channel, channel.width);
        if (!columns_.contains(next)) return {};
        return Failure{Code::trace_shape,
                       fmt::format("has a column {}, but input '{}' has {} elements",
                                   in_quotes(next), channel.name, channel.width),
                       1, 1};
    }

    std::vector<std::string> names_;
    std::map<std::string, Entry> columns_;
};

/// Parses bools as programs write them: Python and pandas True, others true or TRUE.
std::optional<double> parse_bool(std::string_view text) {
    if (text == "True" || text == "true" || text == "TRUE") return 1;
    if (text == "False" || text == "false" || text == "FALSE") return 0;
    return {};
}

class CsvTrace final : public Trace {
public:
    CsvTrace(std::unique_ptr<CsvReader> rows, std::vector<Channel> channels,
             std::vector<Slot> slots, std::size_t columns)
        : rows_(std::move(rows)),
          channels_(std::move(channels)),
          slots_(std::move(slots)),
          columns_(columns) {
        has_.resize(channels_.size());
        for (const Slot& slot : slots_) has_[slot.channel] = true;
    }

    bool has(std::size_t channel) const override { return has_[channel]; }

    diag::Result<bool> next(Sample& sample) override {
        auto more = rows_->next();
        const std::uint32_t line = rows_->row_line();
        bool has_gap = false;
        while (more && *more && columns_ > 1 && rows_->cells() == 1 && rows_->empty()) {
            has_gap = true;
            more = rows_->next();
        }
        if (!more) return of_trace(more.failure());
        if (!*more) return false;
        if (has_gap)
            return Failure{Code::malformed_csv,
                           fmt::format("is an empty line before the last row; a step without "
                                       "samples has {} empty cells",
                                       columns_),
                           line, 1};
        if (rows_->cells() != columns_)
            return Failure{Code::malformed_csv, other_cells(rows_->cells(), columns_),
                           rows_->row_line(), 1};
        sample.values.resize(channels_.size());
        sample.present = has_;
        for (std::size_t c = 0; c < channels_.size(); ++c)
            sample.values[c].resize(channels_[c].width);
        for (const Slot& slot : slots_)
            if (auto failure = read_cell(slot, sample)) return *failure;
        for (std::size_t c = 0; c < channels_.size(); ++c)
            if (!sample.present[c]) sample.values[c].assign(channels_[c].width, kNaN);
        return true;
    }

private:
    std::optional<Failure> read_cell(const Slot& slot, Sample& sample) {
        if (rows_->empty(slot.column)) {
            sample.present[slot.channel] = false;
            return {};
        }
        const bool boolean = channels_[slot.channel].kind == Channel::Kind::boolean;
        const std::string_view cell = rows_->cell(slot.column);
        auto value = rows_->number(slot.column);
        if (!value && boolean) value = parse_bool(cell);
        if (!value && are_times(channels_[slot.channel])) {
            sample.present[slot.channel] = false;
            return {};
        }
        const bool sound =
            value && (!boolean || !std::isfinite(*value) || *value == 0 || *value == 1);
        if (!sound)
            return Failure{
                Code::not_a_number,
                fmt::format(
                    "column {} holds {}, expected {}",
                    in_quotes(column_name(channels_[slot.channel], slot.element)), in_quotes(cell),
                    boolean ? "0 or 1, True or False" : rows_->expected_number(slot.column)),
                rows_->line(slot.column), rows_->column(slot.column)};
        sample.values[slot.channel][slot.element] = std::isfinite(*value) ? *value : kNaN;
        return {};
    }

    std::unique_ptr<CsvReader> rows_;
    std::vector<Channel> channels_;
    std::vector<Slot> slots_;
    std::size_t columns_;
    std::vector<bool> has_;
};

}  // namespace

diag::Result<std::unique_ptr<Trace>> open_csv_trace(std::unique_ptr<ByteSource> source,
                                                    const std::vector<Channel>& channels) {
    auto rows = std::make_unique<CsvReader>(std::move(source));
    const auto header = rows->next();
    if (!header) return of_trace(header.failure());
    if (!*header)
        return Failure{Code::malformed_csv,
                       "is empty, expected a row with the names of the columns"};
    const std::size_t columns = rows->cells();
    auto slots = Header(*rows).slots(channels);
    if (!slots) return slots.failure();
    return std::unique_ptr<Trace>(
        std::make_unique<CsvTrace>(std::move(rows), channels, std::move(*slots), columns));
}

}  // namespace etlc::data
