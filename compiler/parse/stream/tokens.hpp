// Splits a file into tokens without blanks and comments, ended by EOF. Token indices are byte
// offsets in the file; any bytes can be lexed.
#pragma once

#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "antlr4-runtime.h"
#include "ast/ast.hpp"
#include "diag/diag.hpp"
#include "source/source.hpp"

namespace etlc::parse {

using Token = antlr4::Token;

/// Tokens refer to streams that no longer exist, so text_of() takes their text from the file.
using Tokens = std::vector<std::unique_ptr<Token>>;

Tokens tokens_of(const source::File& file);

source::Span span_of(const Token& token);
source::Span span_of(const antlr4::ParserRuleContext& context);
std::string text_of(const Token& token, const source::File& file);
/// Returns the token in quotes, shortened if long; "the end of the file" for EOF.
std::string quoted(const Token& token, const source::File& file);

/// Whether the language has no such token; parse/foreign/mistakes.cpp explains it.
bool is_mistake(const Token& token);

/// Reserved words cannot be names; contextual words can.
bool is_reserved_word(const Token& token, const source::File& file);
/// Whether the rule `name` accepts the token: identifiers and contextual words.
bool is_name(const Token& token);

/// Whether the token has one of these types; false for null.
bool is(const Token* token, std::initializer_list<std::size_t> types);

/// Whether an operand may begin with this token, not counting brackets of vectors and signs.
bool begins_operand(const Token& token);
/// Whether an operand or an interval ends with this token; false for null.
bool ends_operand(const Token* token);

/// Returns the operator of formulas for a token type, if it is one.
std::optional<ast::Formula::Kind> operator_kind(std::size_t type);

/// Returns the spelling of a token type that has only one; otherwise empty.
std::string keyword(std::size_t type);

}  // namespace etlc::parse
