#include "parse/stream/tokens.hpp"

#include <fmt/format.h>

#include <cctype>

#include "EtlLexer.h"
#include "parse/stream/byte_stream.hpp"
#include "source/utf8.hpp"

namespace etlc::parse {

using grammar::EtlLexer;
using source::Span;

Tokens tokens_of(const source::File& file) {
    ByteStream bytes(file.text());
    if (file.text().substr(0, source::kByteOrderMark.size()) == source::kByteOrderMark)
        bytes.seek(source::kByteOrderMark.size());
    EtlLexer lexer(&bytes);
    lexer.removeErrorListeners();  // every byte begins some token: there is nothing to listen to
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

}  // namespace etlc::parse
