// Text to syntax tree. The only place that sees antlr4.
// Takes: a file. Gives: its tree; every syntax error goes to the sink, and what could be read is returned all the same.
// Keeps true: nesting deeper than kMaxNesting is refused before the parser runs; no input crashes or hangs it.
#pragma once

#include "ast/ast.hpp"
#include "diag/diag.hpp"
#include "source/source.hpp"

namespace etlc::parse {

inline constexpr int kMaxNesting = 256;                    ///< brackets, prefix operators and right-associative chains
inline constexpr std::size_t kMaxSpecBytes = 4U << 20U;    ///< larger target sets belong in .npy files

ast::Spec parse(const source::File& file, diag::Sink& sink);

}  // namespace etlc::parse
