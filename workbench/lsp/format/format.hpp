// A spec in its canonical form, with its comments.
// Takes: a file. Gives: the text that has the words, brackets and blanks of `--emit ast`, and the
// comments, line breaks inside declarations and single empty lines of the file; nothing where the
// spec cannot be read, or is in this form. Keeps true: no comment is lost, changed or moved past
// another or past a word; the text reads as the same tree; formatting it again changes nothing.
#pragma once

#include <optional>
#include <string>

#include "source/source.hpp"

namespace etlc::lsp {

std::optional<std::string> formatted(const source::File& file);

}  // namespace etlc::lsp
