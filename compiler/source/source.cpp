#include "source/source.hpp"

#include <algorithm>

namespace etlc::source {

Span join(Span a, Span b) {
    return {std::min(a.begin, b.begin), std::max(a.end, b.end)};
}

File::File(std::string path, std::string text) : path_(std::move(path)), text_(std::move(text)) {
    for (std::uint32_t i = 0; i < text_.size(); ++i)
        if (text_[i] == '\n') line_begins_.push_back(i + 1);
}

std::string_view File::text(Span span) const {
    const std::string_view all = text_;
    return all.substr(std::min<std::size_t>(span.begin, all.size()), span.end - span.begin);
}

Position File::position(std::uint32_t offset) const {
    offset = std::min<std::uint32_t>(offset, static_cast<std::uint32_t>(text_.size()));
    const auto after = std::upper_bound(line_begins_.begin(), line_begins_.end(), offset);
    const auto line = static_cast<std::uint32_t>(after - line_begins_.begin());
    Position result{line, 1};
    for (std::uint32_t i = line_begins_[line - 1]; i < offset; ++i) {
        const bool continuation_byte = (static_cast<unsigned char>(text_[i]) & 0xC0U) == 0x80U;
        if (!continuation_byte) ++result.column;
    }
    return result;
}

std::string_view File::line_text(std::uint32_t line) const {
    const std::uint32_t begin = line_begins_[line - 1];
    std::uint32_t end = line < line_count() ? line_begins_[line] : static_cast<std::uint32_t>(text_.size());
    while (end > begin && (text_[end - 1] == '\n' || text_[end - 1] == '\r')) --end;
    return std::string_view(text_).substr(begin, end - begin);
}

}  // namespace etlc::source
