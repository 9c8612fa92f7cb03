#include "lsp/text/position.hpp"

#include <algorithm>

#include "source/text.hpp"

namespace etlc::lsp {

namespace {

/// Returns the size of the first character; a byte that is not UTF-8 counts as one.
std::size_t bytes_of_first(std::string_view text) {
    return std::max<std::size_t>(1, source::utf8_length(text));
}

/// Characters beyond the basic plane have four bytes and two UTF-16 units.
std::uint32_t units_of(std::size_t bytes, Encoding encoding) {
    if (encoding == Encoding::utf8) return static_cast<std::uint32_t>(bytes);
    return bytes == 4 ? 2 : 1;
}

}  // namespace

Lines::Lines(std::string_view text, Encoding encoding) : text_(text), encoding_(encoding) {
    for (std::uint32_t at = 0; at < text.size(); ++at) {
        const bool ends = text[at] == '\n' ||
                          (text[at] == '\r' && (at + 1 == text.size() || text[at + 1] != '\n'));
        if (ends) begins_.push_back(at + 1);
    }
}

std::uint32_t Lines::end_of(std::size_t line) const {
    if (line + 1 == begins_.size()) return static_cast<std::uint32_t>(text_.size());
    std::uint32_t end = begins_[line + 1] - 1;
    if (text_[end] == '\n' && end > begins_[line] && text_[end - 1] == '\r') --end;
    return end;
}

std::uint32_t Lines::offset(Position position) const {
    if (position.line >= begins_.size()) return static_cast<std::uint32_t>(text_.size());
    const std::uint32_t end = end_of(position.line);
    std::uint32_t at = begins_[position.line];
    std::uint32_t left = position.character;
    while (at < end && left > 0) {
        const std::size_t bytes = bytes_of_first(text_.substr(at));
        const std::uint32_t units = units_of(bytes, encoding_);
        if (units > left) break;
        left -= units;
        at += static_cast<std::uint32_t>(bytes);
    }
    return at;
}

Position Lines::position(std::uint32_t offset) const {
    offset = std::min(offset, static_cast<std::uint32_t>(text_.size()));
    const auto next = std::upper_bound(begins_.begin(), begins_.end(), offset);
    const auto line = static_cast<std::size_t>(next - begins_.begin()) - 1;
    offset = std::min(offset, end_of(line));
    Position result{static_cast<std::uint32_t>(line), 0};
    for (std::uint32_t at = begins_[line]; at < offset;) {
        const std::size_t bytes = bytes_of_first(text_.substr(at));
        if (at + bytes > offset) break;
        result.character += units_of(bytes, encoding_);
        at += static_cast<std::uint32_t>(bytes);
    }
    return result;
}

}  // namespace etlc::lsp
