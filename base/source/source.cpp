#include "source/source.hpp"

#include <algorithm>
#include <limits>

#include "source/text.hpp"

namespace etlc::source {

namespace {

/// Code points are counted once per block, so that finding a position costs the same everywhere in
/// a line of megabytes.
constexpr std::uint32_t kBlock = 1024;

std::uint32_t count_code_points(std::string_view text) {
    return static_cast<std::uint32_t>(
        std::count_if(text.begin(), text.end(), [](char c) { return !is_continuation(c); }));
}

}  // namespace

Span join(Span a, Span b) {
    return {std::min(a.begin, b.begin), std::max(a.end, b.end)};
}

File::File(std::string path, std::string text) : path_(std::move(path)), text_(std::move(text)) {
    // Offsets have 32 bits; callers that read files refuse such a size long before.
    if (text_.size() >= std::numeric_limits<std::uint32_t>::max())
        text_.resize(std::numeric_limits<std::uint32_t>::max() - 1);
    const std::string_view all = text_;
    std::uint32_t code_points = 0;
    for (std::uint32_t i = 0; i < all.size(); ++i)
        if (all[i] == '\n') line_begins_.push_back(i + 1);
    for (std::size_t i = 0; i < all.size(); i += kBlock) {
        code_points += count_code_points(all.substr(i, kBlock));
        code_points_before_.push_back(code_points);
    }
}

std::string_view File::text(Span span) const {
    const std::string_view all = text_;
    const std::size_t begin = std::min<std::size_t>(span.begin, all.size());
    return all.substr(begin, span.end > begin ? span.end - begin : 0);
}

std::uint32_t File::code_points_before(std::uint32_t offset) const {
    const std::uint32_t block = offset / kBlock;
    const std::string_view rest =
        std::string_view(text_).substr(block * kBlock, offset - block * kBlock);
    return code_points_before_[block] + count_code_points(rest);
}

Position File::position(std::uint32_t offset) const {
    offset = std::min<std::uint32_t>(offset, static_cast<std::uint32_t>(text_.size()));
    const auto after = std::upper_bound(line_begins_.begin(), line_begins_.end(), offset);
    const auto line = static_cast<std::uint32_t>(after - line_begins_.begin());
    return {line, 1 + code_points_before(offset) - code_points_before(line_begins_[line - 1])};
}

std::string_view File::line_text(std::uint32_t line) const {
    const std::uint32_t begin = line_begins_[line - 1];
    std::uint32_t end =
        line < line_count() ? line_begins_[line] : static_cast<std::uint32_t>(text_.size());
    while (end > begin && (text_[end - 1] == '\n' || text_[end - 1] == '\r')) --end;
    return std::string_view(text_).substr(begin, end - begin);
}

}  // namespace etlc::source
