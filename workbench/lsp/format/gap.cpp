#include "lsp/format/gap.hpp"

#include <algorithm>
#include <utility>

namespace etlc::lsp {

namespace {

std::size_t end_of_comment(std::string_view text, std::size_t begin, bool to_line_end) {
    if (to_line_end) return std::min(text.size(), text.find_first_of("\r\n", begin));
    const std::size_t end = text.find("*/", begin + 2);
    return end == std::string_view::npos ? text.size() : end + 2;
}

}  // namespace

Gap gap_of(std::string_view between) {
    Gap gap;
    for (std::size_t at = 0; at < between.size();) {
        const char c = between[at];
        const bool line_end = c == '\n' || (c == '\r' && between.substr(at + 1, 1) != "\n");
        if (line_end) ++gap.lines_after;
        if (c != '/') {
            ++at;
            continue;
        }
        const bool to_line_end = between.substr(at + 1, 1) == "/";
        const std::size_t end = end_of_comment(between, at, to_line_end);
        gap.comments.push_back(
            {std::string(between.substr(at, end - at)), gap.lines_after, to_line_end});
        gap.lines_after = 0;
        at = end;
    }
    return gap;
}

void append(Gap& to, Gap more) {
    if (more.comments.empty()) {
        to.lines_after += more.lines_after;
        return;
    }
    more.comments.front().lines_before += to.lines_after;
    std::move(more.comments.begin(), more.comments.end(), std::back_inserter(to.comments));
    to.lines_after = more.lines_after;
}

}  // namespace etlc::lsp
