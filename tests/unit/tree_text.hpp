// Syntax trees as fully bracketed text, spans left out.
// Takes: ast:: structs. Gives: S-expressions, so that equal texts mean equal trees. Keeps true:
// shares nothing with ast::print, which it is used to test.
#pragma once

#include <string>

#include "ast/ast.hpp"

namespace etlc::tree_text {

std::string of(const ast::Expr& expression);
std::string of(const ast::Formula& formula);
std::string of(const ast::Declaration& declaration);
/// The spec's name and declarations, one a line. Unreadable names are left out.
std::string of(const ast::Spec& spec);

}  // namespace etlc::tree_text
