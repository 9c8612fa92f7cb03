#include "parse/stream/tokens.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <iterator>

#include "EtlLexer.h"
#include "source/utf8.hpp"

namespace etlc::parse {

using grammar::EtlLexer;
using source::Span;

namespace {

/// Presents a file to ANTLR with one character per byte, so that ANTLR's indices are byte offsets.
/// Bytes above ASCII read as DEL: they may stand in strings and comments only, where all are alike,
/// and ANTLR caches transitions for ASCII only.
class ByteStream final : public antlr4::CharStream {
public:
    explicit ByteStream(std::string_view text) : text_(text) {}

    void consume() override { seek(at_ + 1); }
    std::size_t LA(ssize_t i) override {
        if (i == 0) return 0;
        const ssize_t at = static_cast<ssize_t>(at_) + (i > 0 ? i - 1 : i);
        if (at < 0 || at >= static_cast<ssize_t>(text_.size())) return EOF;
        constexpr unsigned char kDel = 0x7F;
        return std::min(static_cast<unsigned char>(text_[static_cast<std::size_t>(at)]), kDel);
    }
    ssize_t mark() override { return 0; }
    void release(ssize_t /*marker*/) override {}
    std::size_t index() override { return at_; }
    void seek(std::size_t index) override { at_ = std::min(index, text_.size()); }
    std::size_t size() override { return text_.size(); }
    std::string getSourceName() const override { return {}; }
    std::string getText(const antlr4::misc::Interval& interval) override {
        const auto begin = static_cast<std::size_t>(std::max<ssize_t>(interval.a, 0));
        const auto end = static_cast<std::size_t>(std::max<ssize_t>(interval.b + 1, 0));
        return begin < std::min(end, text_.size()) ? std::string(text_.substr(begin, end - begin))
                                                   : std::string();
    }
    std::string toString() const override { return std::string(text_); }

private:
    std::string_view text_;
    std::size_t at_ = 0;
};

/// Lexes a text from some place between two tokens on.
class TokensFrom {
public:
    TokensFrom(std::string_view text, std::size_t at) : bytes_(text), lexer_(&bytes_) {
        bytes_.seek(at);
        lexer_.removeErrorListeners();  // every byte begins some token, so the lexer has no errors
    }

    /// Returns EOF at the end.
    std::unique_ptr<Token> next() { return lexer_.nextToken(); }

private:
    ByteStream bytes_;
    EtlLexer lexer_;
};

/// Returns the place of the first token or blank.
std::size_t beginning(std::string_view text) {
    return text.starts_with(source::kByteOrderMark) ? source::kByteOrderMark.size() : 0;
}

std::size_t end_of(const Token& token) {
    return token.getStopIndex() + 1;
}

void shift(Token& token, std::size_t by) {  // `by` wraps around for a shift to the left
    auto& common = static_cast<antlr4::CommonToken&>(token);
    common.setStartIndex(token.getStartIndex() + by);
    common.setStopIndex(token.getStopIndex() + by);
}

}  // namespace

Tokens tokens_of(const source::File& file) {
    TokensFrom from(file.text(), beginning(file.text()));
    Tokens tokens;
    do tokens.push_back(from.next());
    while (tokens.back()->getType() != Token::EOF);
    return tokens;
}

void update(Tokens& tokens, std::string_view before, const source::File& file) {
    // The lexer reads at most so many bytes behind a token to end it, as in `<--`.
    constexpr std::size_t kLookedAt = 8;
    const std::string_view text = file.text();
    const std::size_t shorter = std::min(text.size(), before.size());
    const auto same_until =
        std::mismatch(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(shorter),
                      before.begin())
            .first;
    const auto prefix = static_cast<std::size_t>(same_until - text.begin());
    const auto same_from =
        std::mismatch(text.rbegin(), text.rbegin() + static_cast<std::ptrdiff_t>(shorter - prefix),
                      before.rbegin())
            .first;
    const std::size_t suffix = before.size() - static_cast<std::size_t>(same_from - text.rbegin());

    const auto kept_end = std::partition_point(tokens.begin(), tokens.end(), [&](const auto& t) {
        return t->getType() != Token::EOF && end_of(*t) + kLookedAt <= prefix;
    });
    auto rest = std::partition_point(kept_end, tokens.end(),
                                     [&](const auto& t) { return t->getStartIndex() < suffix; });
    const std::size_t from =
        kept_end == tokens.begin() ? beginning(text) : end_of(**(kept_end - 1));
    const std::size_t grown = text.size() - before.size();  // wraps around where it shrank

    // Once a token begins where one of the same rest began before, all others are the same too.
    TokensFrom lexer(text, from);
    Tokens changed;
    for (;;) {
        std::unique_ptr<Token> token = lexer.next();
        const std::size_t start = token->getStartIndex();
        while (rest != tokens.end() && (**rest).getStartIndex() + grown < start) ++rest;
        if (rest != tokens.end() && (**rest).getStartIndex() + grown == start) break;
        changed.push_back(std::move(token));
        if (changed.back()->getType() == Token::EOF) break;
    }
    for (auto at = rest; at != tokens.end(); ++at) shift(**at, grown);
    const auto gap = tokens.erase(kept_end, rest);
    tokens.insert(gap, std::make_move_iterator(changed.begin()),
                  std::make_move_iterator(changed.end()));
}

Span span_of(const Token& token) {
    const auto begin = static_cast<std::uint32_t>(token.getStartIndex());
    if (token.getType() == Token::EOF) return {begin, begin};
    return {begin, static_cast<std::uint32_t>(token.getStopIndex() + 1)};
}

Span span_of(const antlr4::ParserRuleContext& context) {
    return source::join(span_of(*context.start), span_of(*context.stop));
}

std::string text_of(const Token& token, const source::File& file) {
    return std::string(file.text(span_of(token)));
}

std::string quoted(const Token& token, const source::File& file) {
    if (token.getType() == Token::EOF) return "the end of the file";
    constexpr std::size_t kLongest = 40;
    std::string text = text_of(token, file);
    if (text.size() > kLongest) text = text.substr(0, kLongest) + "...";
    return token.getType() == EtlLexer::STRING ? text : fmt::format("'{}'", text);
}

bool is_mistake(const Token& token) {
    switch (token.getType()) {
        case EtlLexer::UNTERMINATED_STRING:
        case EtlLexer::UNTERMINATED_COMMENT:
        case EtlLexer::MALFORMED_NUMBER:
        case EtlLexer::FOREIGN_OPERATOR:
        case EtlLexer::UNEXPECTED: return true;
        default: return false;
    }
}

bool is_reserved_word(const Token& token, const source::File& file) {
    if (token.getType() < EtlLexer::SPEC || token.getType() > EtlLexer::HISTORICALLY) return false;
    return std::isalpha(static_cast<unsigned char>(file.text(span_of(token))[0])) != 0;
}

bool is_name(const Token& token) {
    return token.getType() >= EtlLexer::IN && token.getType() <= EtlLexer::IDENTIFIER;
}

bool is(const Token* token, std::initializer_list<std::size_t> types) {
    return token != nullptr &&
           std::find(types.begin(), types.end(), token->getType()) != types.end();
}

bool begins_operand(const Token& token) {
    return is_name(token) ||
           is(&token, {EtlLexer::NUMBER, EtlLexer::TRUE, EtlLexer::FALSE, EtlLexer::LPAREN,
                       EtlLexer::NOT, EtlLexer::NEXT, EtlLexer::EVENTUALLY, EtlLexer::ALWAYS,
                       EtlLexer::PREVIOUS, EtlLexer::ONCE, EtlLexer::HISTORICALLY});
}

bool ends_operand(const Token* token) {
    return token != nullptr &&
           (is_name(*token) || is(token, {EtlLexer::NUMBER, EtlLexer::TRUE, EtlLexer::FALSE,
                                          EtlLexer::RPAREN, EtlLexer::RBRACKET}));
}

std::optional<ast::Formula::Kind> operator_kind(std::size_t type) {
    switch (type) {
#define OPERATOR(name, token, ...) \
    case EtlLexer::token:          \
        return ast::Formula::Kind::name;
#include "ast/operators.def"
#undef OPERATOR
        default: return std::nullopt;
    }
}

std::string keyword(std::size_t type) {
    const std::string quoted = EtlLexer(nullptr).getVocabulary().getLiteralName(type);
    return quoted.size() > 2 ? quoted.substr(1, quoted.size() - 2) : "";
}

}  // namespace etlc::parse
