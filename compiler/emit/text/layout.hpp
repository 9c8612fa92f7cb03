// The layout of generated code: numbers, comments, and statements in lines of at most kLineWidth
// columns, where they can be broken. A statement breaks at its outermost operator or bracket first;
// statements under a condition are in braces.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "emit/text/printer.hpp"
#include "plan/plan.hpp"

namespace etlc::emit {

/// Returns a float32 literal that reads back to the same bits: "0.31f".
std::string float_literal(float x);

/// Returns spec text on one line, shortened if it is long.
std::string quoted(std::string_view text);

/// Prints a statement, or the line that opens a block ("if (...) {"). `if (c) s;` becomes a block.
void print_wrapped(Printer& out, const std::string& text);

/// Prints a statement with a comment: on one line if both fit, otherwise above it.
void print_with_comment(Printer& out, const std::string& text, const std::string& comment);

/// Returns the length of the longest beginning of a text that fits and ends between words, neither
/// inside an interval "F[0, 8 s]" nor before a unit; of the first word if even that does not fit.
std::size_t fitting(std::string_view text, std::size_t width);

/// Prints a comment, broken between words. Each line begins with the mark and a blank; lines after
/// the first have `hang` more blanks.
void print_comment(Printer& out, std::string_view mark, std::string_view text,
                   std::size_t hang = 0);

/// Prints a documentation comment, with three slashes.
void print_doc(Printer& out, std::string_view text);

/// Prints declarations with their comments in one column. Long comments go above the declaration.
void print_aligned(Printer& out,
                   const std::vector<std::pair<std::string, std::string>>& declarations,
                   std::string_view mark = "//");

/// Returns the statement that increments a counter, which saturates.
std::string counted(std::string_view counter);

// Names of functions that generated code has anyway, which no local may have.

/// Returns the functions with an underscore in their names: of the runtime, and of the class, named
/// after predicates and monitors.
std::set<std::string> function_names(const plan::Plan& plan);

// Prints tables of text, in a comment of the header or in a report.

using Row = std::vector<std::string>;

/// Returns the text of a cell: a formula, cut if it is long; a number.
std::string shortened(const std::string& formula);
std::string number(std::uint64_t x);

/// Returns whether lines with this prefix are a comment, which is no wider than code.
bool is_comment(const std::string& prefix);

/// Prints a table. Columns from `first_number` on are numbers, and right-aligned.
void print_table(Printer& out, const std::string& prefix, const std::vector<Row>& rows,
                 std::size_t first_number);

}  // namespace etlc::emit
