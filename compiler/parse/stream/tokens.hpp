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
#include "parse/stream/words.hpp"
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

/// Whether the language has no such token; parse/foreign/foreign.cpp explains it.
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

/// The words of a file that has been lexed.
std::vector<Word> words_of(const Tokens& tokens, const source::File& file);

// Splits tokens into slices, one for each declaration, which are parsed separately. A slice ends
// with its ';', before a word that begins another declaration, or at EOF. Slices cover all tokens
// but EOF in order, so an error in one cannot affect another.

struct Slice {
    std::size_t begin;  ///< index of the first token
    std::size_t end;    ///< index after the last token; a token exists there, EOF at the latest
};

std::vector<Slice> slices_of(const Tokens& tokens);

/// Returns the first token that nests deeper than kMaxNesting, before ANTLR's recursive descent
/// gets there. Accepted slices recurse at most kMaxNesting times a grammar rule, here and in every
/// walk over the tree.
std::optional<std::size_t> too_deep_at(const Tokens& tokens, Slice slice);

/// One slice as ANTLR's token stream, with EOF at its end.
class SliceStream final : public antlr4::TokenStream {
public:
    SliceStream(const Tokens& tokens, Slice slice);

    Token* LT(ssize_t k) override;
    std::size_t LA(ssize_t i) override { return LT(i)->getType(); }
    Token* get(std::size_t index) const override;
    void consume() override;
    ssize_t mark() override { return 0; }
    void release(ssize_t /*marker*/) override {}
    std::size_t index() override { return at_; }
    void seek(std::size_t index) override;
    std::size_t size() override { return slice_.end - slice_.begin; }

    antlr4::TokenSource* getTokenSource() const override {
        return tokens_[slice_.begin]->getTokenSource();
    }
    std::string getSourceName() const override { return {}; }
    // The stream is never asked for text, which the file has.
    std::string getText(const antlr4::misc::Interval& /*interval*/) override { return {}; }
    std::string getText() override { return {}; }
    std::string getText(antlr4::RuleContext* /*context*/) override { return {}; }
    std::string getText(Token* /*start*/, Token* /*stop*/) override { return {}; }

private:
    const Tokens& tokens_;
    Slice slice_;
    std::size_t at_ = 0;  ///< from the beginning of the slice
    antlr4::CommonToken end_;
};

}  // namespace etlc::parse
