// What lies between two words of a spec: comments, and line ends around them.
// Takes: the text between them. Gives: its comments in order, each as it is written. Keeps true:
// every byte that is no blank belongs to a comment.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace etlc::lsp {

struct Comment {
    std::string text;
    int lines_before = 0;      ///< line ends between it and what stands before it
    bool to_line_end = false;  ///< begun by //
};

struct Gap {
    std::vector<Comment> comments;
    int lines_after = 0;  ///< line ends behind the last comment, or in the whole gap

    bool is_plain() const { return comments.empty() && lines_after == 0; }
};

Gap gap_of(std::string_view between);

/// One gap behind the other, as where the bracket between them is left out.
void append(Gap& to, Gap more);

}  // namespace etlc::lsp
