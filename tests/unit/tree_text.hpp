// Prints syntax trees as fully bracketed text, without spans.
// Takes: ast:: structs. Gives: S-expressions, so equal texts mean equal trees. Keeps true: it
// shares nothing with ast::print, which it helps to test.
#pragma once

#include <string>

#include "ast/ast.hpp"

namespace etlc::tree_text {

std::string of(const ast::Expr& expression);
std::string of(const ast::Formula& formula);
std::string of(const ast::Declaration& declaration);
/// Prints the spec's name and declarations, one per line. Unreadable names are omitted.
std::string of(const ast::Spec& spec);

}  // namespace etlc::tree_text
