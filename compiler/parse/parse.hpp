// Parses text into a syntax tree; this is the only folder that uses ANTLR. Errors go to the sink,
// and everything that could be read is returned. An error ends with its declaration; nesting deeper
// than kMaxNesting is refused before the parser runs; no input crashes or hangs it; time is linear
// in the text.
#pragma once

#include "ast/ast.hpp"
#include "diag/diag.hpp"
#include "source/source.hpp"

namespace etlc::parse {

/// Limit on nested brackets, prefix operators and right-associative operators.
inline constexpr int kMaxNesting = 800;
/// Limit on the nodes on the longest path of a declaration's tree, so that later stages may
/// recurse. `&&` and `||` are one node whatever the number of operands; a sum of n terms is n - 1
/// nodes deep, since + - * / and <-> associate to the left.
inline constexpr int kMaxHeight = 1000;
/// Larger target sets belong in .npy files.
inline constexpr std::size_t kMaxSpecBytes = 1U << 20U;

ast::Spec parse(const source::File& file, diag::Sink& sink);

}  // namespace etlc::parse
