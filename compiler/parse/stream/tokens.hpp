// Text to tokens.
// Takes: a file. Gives: its tokens without blanks and comments, ended by EOF. Keeps true: a token's
// indices are byte offsets of the file; any bytes can be lexed.
#pragma once

#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "antlr4-runtime.h"
#include "ast/ast.hpp"
#include "diag/diag.hpp"
#include "source/source.hpp"

namespace etlc::parse {

using Token = antlr4::Token;

/// Tokens refer to the streams they came from but are never asked for their text: that is the
/// file's.
using Tokens = std::vector<std::unique_ptr<Token>>;

Tokens tokens_of(const source::File& file);

source::Span span_of(const Token& token);
source::Span span_of(const antlr4::ParserRuleContext& context);
std::string text_of(const Token& token, const source::File& file);
/// 'word', cut where it is long; "the end of the file" for EOF.
std::string quoted(const Token& token, const source::File& file);

/// What the lexer found to be none of the language's words: parse/foreign/mistakes.hpp explains it.
bool is_mistake(const Token& token);

/// Reserved words cannot be names; contextual words can.
bool is_reserved_word(const Token& token, const source::File& file);
/// Identifiers and contextual words: whatever the rule `name` takes.
bool is_name(const Token& token);

/// Whether a token is of one of these types; null is of none.
bool is(const Token* token, std::initializer_list<std::size_t> types);

/// Whether an operand may begin with this token, brackets of vectors and signs aside.
bool begins_operand(const Token& token);
/// Whether an operand, or an interval, ends with this token; null: there is none.
bool ends_operand(const Token* token);

/// The operator of formulas that tokens of a type are; nothing where they are none.
std::optional<ast::Formula::Kind> operator_kind(std::size_t type);

/// The spelling of tokens that have only one; else empty.
std::string keyword(std::size_t type);

}  // namespace etlc::parse
