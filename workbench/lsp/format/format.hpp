// Formats a spec.
// Takes: a file. Gives: a text with the words, brackets and blanks of `--emit ast`, and the
// comments, line breaks inside declarations and single empty lines of the file. Keeps true: no
// comment is lost, changed or moved past another comment or a word (it may move past a bracket that
// is dropped because it changes nothing); the text parses to the same tree; formatting is
// idempotent.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "parse/stream/words.hpp"
#include "source/source.hpp"

namespace etlc::lsp {

/// A comment between two words.
struct Comment {
    std::string text;
    int lines_before = 0;      ///< line ends before it
    bool to_line_end = false;  ///< starts with //
};

/// The comments and line ends between two words of a spec.
struct Gap {
    std::vector<Comment> comments;
    int lines_after = 0;  ///< line ends after the last comment, or in the whole gap

    bool is_plain() const { return comments.empty() && lines_after == 0; }
};

/// Parses the text between two words.
Gap gap_of(std::string_view between);

/// Joins two gaps, where the bracket between them is dropped.
void append(Gap& to, Gap more);

/// Formats a declaration. `written`: its words up to the semicolon; `canonical`: its canonical text
/// on one line.
std::string formatted_declaration(const source::File& file, const std::vector<parse::Word>& written,
                                  const std::string& canonical, std::string_view line_end);

/// Formats a file; nothing where it cannot be parsed.
std::optional<std::string> formatted(const source::File& file);

}  // namespace etlc::lsp
