// Text to syntax tree. The only place that sees antlr4.
// Takes: a file. Gives: its tree; every syntax error goes to the sink, and what could be read is
// returned all the same. Keeps true: an error ends with its declaration; nesting deeper than
// kMaxNesting is refused before the parser runs; no input crashes or hangs it, and time is linear
// in the text.
#pragma once

#include "ast/ast.hpp"
#include "diag/diag.hpp"
#include "source/source.hpp"

namespace etlc::parse {

/// Brackets, prefix operators and right-associative operators that stand inside one another.
inline constexpr int kMaxNesting = 256;
/// Nodes on the longest path of one declaration's tree. `&&` and `||` of any number of operands are
/// one node; a sum of n terms is n - 1 nodes deep, since + - * / and <-> associate to the left. So
/// later stages may walk trees by recursion.
inline constexpr int kMaxHeight = 1000;
/// Larger target sets belong in .npy files.
inline constexpr std::size_t kMaxSpecBytes = 1U << 20U;

ast::Spec parse(const source::File& file, diag::Sink& sink);

}  // namespace etlc::parse
