#include "parse/stream/tokens.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "EtlLexer.h"
#include "source/text.hpp"

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

}  // namespace

Tokens tokens_of(const source::File& file) {
    const std::string_view text = file.text();
    ByteStream bytes(text);
    if (text.starts_with(source::kByteOrderMark)) bytes.seek(source::kByteOrderMark.size());
    EtlLexer lexer(&bytes);
    lexer.removeErrorListeners();  // every byte begins some token, so the lexer has no errors
    Tokens tokens;
    do tokens.push_back(lexer.nextToken());
    while (tokens.back()->getType() != Token::EOF);
    return tokens;
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

namespace {

/// Whether a declaration begins at token `i`. Its first words decide, since a declaration word
/// alone may be a reserved word mistaken for a name.
bool begins_declaration(const Tokens& tokens, std::size_t i) {
    const auto type = [&tokens](std::size_t k) {
        return k < tokens.size() ? tokens[k]->getType() : Token::EOF;
    };
    const bool name_follows = i + 1 < tokens.size() && is_name(*tokens[i + 1]);
    switch (type(i)) {
        case EtlLexer::SPEC: return name_follows && type(i + 2) == EtlLexer::SEMICOLON;
        case EtlLexer::RATE:
        case EtlLexer::PERIOD: return type(i + 1) == EtlLexer::NUMBER || name_follows;
        case EtlLexer::INPUT:
            return name_follows &&
                   (type(i + 2) == EtlLexer::COMMA || type(i + 2) == EtlLexer::COLON);
        case EtlLexer::SLIDING:
        case EtlLexer::RESTARTABLE:
        case EtlLexer::REPEATING: return type(i + 1) == EtlLexer::MONITOR;
        case EtlLexer::PROJECTION:
        case EtlLexer::ENCODER:
        case EtlLexer::DRIFT:
        case EtlLexer::CONST:
        case EtlLexer::TARGET:
        case EtlLexer::PREDICATE:
        case EtlLexer::TRUTH:
        case EtlLexer::LET:
        case EtlLexer::MONITOR: return name_follows && type(i + 2) == EtlLexer::ASSIGN;
        default: return false;
    }
}

}  // namespace

std::vector<Slice> slices_of(const Tokens& tokens) {
    std::vector<Slice> slices;
    std::size_t begin = 0;
    const std::size_t last = tokens.size() - 1;  // EOF
    for (std::size_t i = 0; i < last; ++i) {
        const bool of_a_kind = i == begin + 1 && tokens[i]->getType() == EtlLexer::MONITOR &&
                               begins_declaration(tokens, begin);
        if (i > begin && !of_a_kind && begins_declaration(tokens, i)) {
            slices.push_back({begin, i});
            begin = i;
        }
        const auto is_semicolon = [&tokens](std::size_t k) {
            return tokens[k]->getType() == EtlLexer::SEMICOLON;
        };
        // A run of stray ';' is one slice and one error.
        if (is_semicolon(begin) && is_semicolon(i) && is_semicolon(i + 1)) continue;
        if (is_semicolon(i)) {
            slices.push_back({begin, i + 1});
            begin = i + 1;
        }
    }
    if (begin < last) slices.push_back({begin, last});
    return slices;
}

SliceStream::SliceStream(const Tokens& tokens, Slice slice)
    : tokens_(tokens), slice_(slice), end_(Token::EOF) {
    end_.setStartIndex(tokens[slice.end]->getStartIndex());
    end_.setStopIndex(tokens[slice.end]->getStartIndex());
    end_.setTokenIndex(slice.end - slice.begin);
}

Token* SliceStream::LT(ssize_t k) {
    if (k == 0) return nullptr;
    const ssize_t at = static_cast<ssize_t>(at_) + (k > 0 ? k - 1 : k);
    return at < 0 ? nullptr : get(static_cast<std::size_t>(at));
}

Token* SliceStream::get(std::size_t index) const {
    if (index >= slice_.end - slice_.begin) return const_cast<antlr4::CommonToken*>(&end_);
    return tokens_[slice_.begin + index].get();
}

void SliceStream::consume() {
    if (at_ < size()) ++at_;
}

void SliceStream::seek(std::size_t index) {
    at_ = std::min(index, size());
}

}  // namespace etlc::parse
