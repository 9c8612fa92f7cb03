#include "parse/tokens.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

#include "EtlLexer.h"
#include "parse/byte_stream.hpp"
#include "source/utf8.hpp"

namespace etlc::parse {

using grammar::EtlLexer;
using source::Span;

namespace {

struct Hint {
    std::string_view written;
    std::string_view hint;
    std::string_view meant = "";  ///< where there is but one thing to write instead
};

constexpr std::array kHints{
    Hint{"===", "'equal' is '=='; formulas are compared with '<->'", "=="},
    Hint{"!==", "'not equal' is '!='; 'not' is '!'"},
    Hint{"<>", "'not equal' is '!='", "!="},
    Hint{"=>", "'implies' is '->', 'greater or equal' is '>='"},
    Hint{"<=>", "'if and only if' is '<->'", "<->"},
    Hint{"=<", "'less or equal' is '<='", "<="},
    Hint{"<-->", "'if and only if' is '<->'", "<->"},
    Hint{"-->", "'implies' is '->'", "->"},
    Hint{"&", "'and' is '&&'", "&&"},
    Hint{"/\\", "'and' is '&&'", "&&"},
    Hint{"|", "'or' is '||'", "||"},
    Hint{"\\/", "'or' is '||'", "||"},
    Hint{"~", "'not' is '!'", "!"},
    Hint{"^", "there are no powers; a square is a product"},
    Hint{"**", "there are no powers; a square is a product"},
    Hint{":=", "a declaration has '=' after its name"},
    Hint{"{", "a spec has no blocks; formulas are grouped by '( )'"},
    Hint{"}", "a spec has no blocks; formulas are grouped by '( )'"},
    Hint{"'", "a file name stands between double quotes"},
    Hint{"#", "a comment begins with '//'", "//"},
    Hint{"≤", "'less or equal' is '<='", "<="},
    Hint{"≥", "'greater or equal' is '>='", ">="},
    Hint{"∧", "'and' is '&&'", "&&"},
    Hint{"∨", "'or' is '||'", "||"},
    Hint{"¬", "'not' is '!'", "!"},
    Hint{"→", "'implies' is '->'", "->"},
    Hint{"⇒", "'implies' is '->'", "->"},
    Hint{"↔", "'if and only if' is '<->'", "<->"},
    Hint{"□", "'always' is 'G'", "G"},
    Hint{"◇", "'eventually' is 'F'", "F"},
    Hint{"♢", "'eventually' is 'F'", "F"},
    Hint{"○", "'next' is 'X'", "X"},
    Hint{"−", "this is not the minus sign '-'", "-"},
    Hint{"–", "this is not the minus sign '-'", "-"},
    Hint{"×", "a product is written '*'", "*"},
    Hint{"·", "a product is written '*'", "*"},
    Hint{"∞", "infinity is written 'inf'", "inf"},
    Hint{"“", "a file name stands between plain double quotes"},
    Hint{"”", "a file name stands between plain double quotes"},
    Hint{"\xC2\xA0", "this is a no-break space; put a plain space"},
};

void add_hint(diag::Diagnostic& to, std::string_view written) {
    const auto* const found = std::find_if(
        kHints.begin(), kHints.end(), [written](const Hint& h) { return h.written == written; });
    if (found == kHints.end()) return;
    to.note(std::string(found->hint));
    to.meant = found->meant;
}

diag::Diagnostic diagnostic(diag::Code code, Span span, std::string message) {
    return {code, std::move(message), span, {}, 0, 0, {}};
}

std::optional<diag::Diagnostic> explain_character(Span span, const source::File& file) {
    const std::size_t length = source::utf8_length(file.text().substr(span.begin));
    if (length == 0) return std::nullopt;
    span.end = span.begin + static_cast<std::uint32_t>(length);
    const std::string character(file.text(span));
    const auto byte = static_cast<unsigned char>(character[0]);
    const bool control = length == 1 && (byte < 0x20 || byte == 0x7F);
    std::string message = control ? fmt::format("unexpected character U+{:04X}", byte)
                                  : fmt::format("unexpected character '{}'", character);
    diag::Diagnostic result =
        diagnostic(diag::Code::unexpected_character, span, std::move(message));
    add_hint(result, character);
    return result;
}

}  // namespace

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

std::optional<diag::Diagnostic> explain_mistake(const Token& token, const source::File& file) {
    const Span span = span_of(token);
    switch (token.getType()) {
        case EtlLexer::UNTERMINATED_STRING:
            return diagnostic(diag::Code::unterminated, {span.begin, span.begin + 1},
                              "this string has no closing '\"' on its line");
        case EtlLexer::UNTERMINATED_COMMENT:
            return diagnostic(diag::Code::unterminated, {span.begin, span.begin + 2},
                              "this comment has no closing '*/'");
        case EtlLexer::MALFORMED_NUMBER: {
            diag::Diagnostic result =
                diagnostic(diag::Code::malformed_number, span,
                           fmt::format("{} is not a number", quoted(token, file)));
            result.note(
                "numbers are decimal, with digits on both sides of a point: 2, 0.5, 1.0e-3");
            return result;
        }
        case EtlLexer::FOREIGN_OPERATOR: {
            diag::Diagnostic result =
                diagnostic(diag::Code::unexpected_character, span,
                           fmt::format("there is no operator {}", quoted(token, file)));
            add_hint(result, file.text(span));
            return result;
        }
        default: return explain_character(span, file);
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
