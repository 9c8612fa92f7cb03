// Splits a file into tokens without blanks and comments, ended by EOF. Token indices are byte
// offsets in the file; any bytes can be lexed.
#pragma once

#include <cstddef>
#include <exception>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "EtlParser.h"
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

// The state of ANTLR's parser where it cannot go on.

struct Stuck {
    const Token* found;            ///< EOF if the slice ended
    const Token* previous;         ///< nullptr if nothing was read yet
    const Token* before_previous;  ///< nullptr if there is none
    const Token* following;        ///< after `found`; nullptr at the end of the slice
    antlr4::misc::IntervalSet expected;
    std::size_t rule;         ///< EtlParser::Rule...
    std::size_t parent_rule;  ///< of the calling rule
    std::size_t declaration;  ///< type of the first token in the slice
    bool looked_ahead;        ///< `found` lies after the token at which the parser had to decide

    bool expects(std::size_t type) const { return expected.contains(type); }

    /// Returns the rule that the parser is in, or the one around a name.
    std::size_t rule_around() const {
        return rule == grammar::EtlParser::RuleName ? parent_rule : rule;
    }

    /// Whether the place is in the declaration of a let, a truth or a monitor.
    bool in_formula() const {
        switch (declaration) {
            case grammar::EtlParser::LET:
            case grammar::EtlParser::TRUTH:
            case grammar::EtlParser::MONITOR:
            case grammar::EtlParser::SLIDING:
            case grammar::EtlParser::RESTARTABLE:
            case grammar::EtlParser::REPEATING: return true;
            default: return false;
        }
    }
};

/// Stops the parser at its first error; ANTLR's own recovery and messages are never used.
class StopAtError : public antlr4::ANTLRErrorStrategy {
public:
    void reset(antlr4::Parser* /*parser*/) override {}
    Token* recoverInline(antlr4::Parser* parser) override {
        stop(parser, parser->getCurrentToken());
        return nullptr;
    }
    void recover(antlr4::Parser* parser, std::exception_ptr error) override {
        try {
            std::rethrow_exception(error);
        } catch (const antlr4::RecognitionException& e) {
            stop(parser, e.getOffendingToken());
        }
    }
    void sync(antlr4::Parser* /*parser*/) override {}
    bool inErrorRecoveryMode(antlr4::Parser* /*parser*/) override { return false; }
    void reportMatch(antlr4::Parser* /*parser*/) override {}
    void reportError(antlr4::Parser* /*parser*/,
                     const antlr4::RecognitionException& /*error*/) override {}

private:
    /// Throws.
    virtual void stop(antlr4::Parser* parser, const Token* found) = 0;
};

}  // namespace etlc::parse
