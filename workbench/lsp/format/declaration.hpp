// One declaration in its canonical form, with the comments and line breaks that it has.
// Takes: its canonical text in one line, and the file with the words that it is written in. Gives:
// its text. Keeps true: a comment stays between the same two words, brackets aside: those that
// change nothing are left out, and where they were a comment may move past one.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "parse/words.hpp"
#include "source/source.hpp"

namespace etlc::lsp {

/// `written`: from the first word to the semicolon.
std::string formatted_declaration(const source::File& file, const std::vector<parse::Word>& written,
                                  const std::string& canonical, std::string_view line_end);

}  // namespace etlc::lsp
