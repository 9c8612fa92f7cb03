// How generated code is laid out: where lines break, and how numbers and comments are written.
// Takes: statements, declarations and comments as text. Gives: lines of at most kLineWidth columns
// wherever the text can be broken. Keeps true: a statement breaks where a reader would break it, at
// the outermost operator or bracket first; what depends on a condition stands in braces.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "emit/text/printer.hpp"

namespace etlc::emit {

/// A float32 literal that reads back to the same bits: "0.31f".
std::string float_literal(float x);

/// Spec text on one line, shortened where it is long.
std::string quoted(std::string_view text);

/// One statement, or the line that opens a block ("if (...) {"). `if (c) s;` becomes a block.
void print_wrapped(Printer& out, const std::string& text);

/// The same with a comment: behind it where both fit in a line, else above it.
void print_with_comment(Printer& out, const std::string& text, const std::string& comment);

/// A comment, broken between words: each line begins with the mark and a blank, those after the
/// first with `hang` blanks more.
void print_comment(Printer& out, std::string_view mark, std::string_view text,
                   std::size_t hang = 0);

/// The documentation of what follows: a comment with three slashes.
void print_doc(Printer& out, std::string_view text);

/// Declarations with their comments in one column; above the declaration, where a comment is long.
void print_aligned(Printer& out,
                   const std::vector<std::pair<std::string, std::string>>& declarations,
                   std::string_view mark = "//");

/// A statement: one more, if there is such a number.
std::string counted(std::string_view counter);

}  // namespace etlc::emit
