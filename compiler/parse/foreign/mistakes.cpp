// Explains mistaken tokens: characters, numbers and operators that the language does not have.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "EtlLexer.h"
#include "parse/foreign/foreign.hpp"
#include "source/text.hpp"

namespace etlc::parse {

using grammar::EtlLexer;
using source::Span;

namespace {

struct Hint {
    std::string_view written;  ///< synonyms, separated by blanks
    std::string_view hint;
    std::string_view meant = "";  ///< replacement, if there is only one
};

constexpr std::array kHints{
    Hint{"===", "'equal' is '=='; formulas are compared with '<->'", "=="},
    Hint{"!==", "'not equal' is '!='; 'not' is '!'"},
    Hint{"<> ≠", "'not equal' is '!='", "!="},
    Hint{"=>", "'implies' is '->', 'greater or equal' is '>='"},
    Hint{"<=> <--> ↔ ⇔ ⟷ ⟺", "'if and only if' is '<->'", "<->"},
    Hint{"--> → ⇒ ⟶ ⟹", "'implies' is '->'", "->"},
    Hint{"=< ≤", "'less or equal' is '<='", "<="},
    Hint{"≥", "'greater or equal' is '>='", ">="},
    Hint{"& /\\ ⋀ ∧", "'and' is '&&'", "&&"},
    Hint{"| \\/ ⋁ ∨", "'or' is '||'", "||"},
    Hint{"~ ¬", "'not' is '!'", "!"},
    Hint{"⊤", "'true' is 'true'", "true"},
    Hint{"⊥", "'false' is 'false'", "false"},
    Hint{"□ ◻", "'always' is 'G'", "G"},
    Hint{"◊ ⬦ ◇ ♢", "'eventually' is 'F'", "F"},
    Hint{"○ ◯", "'next' is 'X'", "X"},
    Hint{"𝒰", "'until' is 'U'", "U"},
    Hint{"^", "there are no powers; a square is a product; 'either f or g' is '!(f <-> g)'"},
    Hint{"** ²", "there are no powers; a square is a product"},
    Hint{"√", "the square root of x is sqrt(x)"},
    Hint{"× ·", "a product is written '*'", "*"},
    Hint{"− –", "this is not the minus sign '-'", "-"},
    Hint{"∞", "infinity is written 'inf'", "inf"},
    Hint{"µ μ", "microseconds are 'us'", "u"},
    Hint{"…", "bounds are separated by a comma: [0, 2 s]"},
    Hint{":=", "a declaration has '=' after its name", "="},
    Hint{"%", "a comment begins with '//'; there are no remainders"},
    Hint{"#", "a comment begins with '//'", "//"},
    Hint{"{ }", "a spec has no blocks; formulas are grouped with '( )'"},
    Hint{"' ‘ ’", "file names are written in double quotes"},
    Hint{"„ « » “ ”", "file names are written in plain double quotes"},
    Hint{"\xC2\xA0", "this is a no-break space; use a plain space", " "},
    Hint{"\xE2\x80\x87", "this is a figure space; use a plain space", " "},
    Hint{"\xE2\x80\x89", "this is a thin space; use a plain space", " "},
    Hint{"\xE2\x80\xAF", "this is a narrow no-break space; use a plain space", " "},
    Hint{"\xE3\x80\x80", "this is an ideographic space; use a plain space", " "},
    Hint{"\xE2\x80\x8B", "this is a zero-width space; remove it"},
    Hint{"\xEF\xBB\xBF", "this is a byte order mark; remove it"},
};

/// Some mean something else where an operand should begin.
constexpr std::array kHintsBeforeOperand{
    Hint{"<>", "'eventually' is 'F'", "F"},
    Hint{"|", "the absolute value of x is abs(x)"},
};
constexpr Hint kIntervalInBraces{
    "{", "an interval is written in square brackets, F[0, 2 s]; formulas are grouped with '( )'"};

const Hint* hint_for(std::string_view written, const Token* previous, const source::File& file) {
    const auto in = [written](const auto& hints) -> const Hint* {
        const auto* const found =
            std::find_if(hints.begin(), hints.end(),
                         [written](const Hint& h) { return is_listed(h.written, written); });
        return found == hints.end() ? nullptr : found;
    };
    const bool behind_name = previous != nullptr && text_of(*previous, file).ends_with('_');
    const bool behind_operator =
        previous != nullptr && ((previous->getType() >= EtlLexer::UNTIL &&
                                 previous->getType() <= EtlLexer::HISTORICALLY) ||
                                previous->getType() == EtlLexer::HELD);
    if (written == "{" && (behind_name || behind_operator)) return &kIntervalInBraces;
    const Hint* const before_operand = ends_operand(previous) ? nullptr : in(kHintsBeforeOperand);
    return before_operand != nullptr ? before_operand : in(kHints);
}

void add_hint(diag::Diagnostic& to, std::string_view written, const Token* previous,
              const source::File& file) {
    if (const Hint* const hint = hint_for(written, previous, file)) {
        to.note(std::string(hint->hint));
        to.meant = hint->meant;
    } else if (written.size() > 1 && static_cast<unsigned char>(written[0]) >= 0x80) {
        to.note("outside comments and strings a spec is ASCII");
    }
}

constexpr const char* kCommaInInterval = "bounds are separated by a comma: [0, 2 s]";

/// `0.` and `..` in 0..2.
bool begins_dots(Span span, const source::File& file) {
    const std::string_view rest = file.text().substr(span.begin);
    return rest.starts_with("..") || file.text().substr(span.end).starts_with('.');
}

/// Completes a number: .5, 5., 0.5f.
std::string mended(std::string number) {
    const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
    if (number.starts_with('.')) return "0" + number;
    if (number.ends_with('.')) return number + "0";
    if (number.find('x') != number.npos || number.find('X') != number.npos) return "";
    if (number.ends_with('f') || number.ends_with('F')) number.pop_back();
    return is_digit(number.back()) ? number : "";
}

std::optional<diag::Diagnostic> explain_character(Span span, const Token* previous,
                                                  const source::File& file) {
    const std::size_t length = source::utf8_length(file.text().substr(span.begin));
    if (length == 0) return std::nullopt;
    span.end = span.begin + static_cast<std::uint32_t>(length);
    const std::string character(file.text(span));
    const auto byte = static_cast<unsigned char>(character[0]);
    const bool control = length == 1 && (byte < 0x20 || byte == 0x7F);
    std::string message = control ? fmt::format("unexpected character U+{:04X}", byte)
                                  : fmt::format("unexpected character '{}'", character);
    diag::Diagnostic result{diag::Code::unexpected_character, std::move(message), span};
    if (character == "." && begins_dots(span, file))
        result.note(kCommaInInterval);
    else
        add_hint(result, character, previous, file);
    return result;
}

}  // namespace

std::optional<diag::Diagnostic> explain_mistake(const Token& token, const Token* previous,
                                                const source::File& file) {
    const Span span = span_of(token);
    switch (token.getType()) {
        case EtlLexer::UNTERMINATED_STRING:
            return diag::Diagnostic{diag::Code::unterminated,
                                    "this string has no closing '\"' on its line",
                                    Span{span.begin, span.begin + 1}};
        case EtlLexer::UNTERMINATED_COMMENT:
            return diag::Diagnostic{diag::Code::unterminated, "this comment has no closing '*/'",
                                    Span{span.begin, span.begin + 2}};
        case EtlLexer::MALFORMED_NUMBER: {
            diag::Diagnostic result{diag::Code::malformed_number,
                                    fmt::format("{} is not a number", quoted(token, file)), span};
            if (begins_dots(span, file)) {
                result.note(kCommaInInterval);
                return result;
            }
            result.note(
                "numbers are decimal, with digits on both sides of a point: 2, 0.5, 1.0e-3");
            const std::string number = mended(text_of(token, file));
            if (!number.empty()) diag::did_you_mean(result, number);
            return result;
        }
        case EtlLexer::FOREIGN_OPERATOR: {
            diag::Diagnostic result{diag::Code::unexpected_character,
                                    fmt::format("there is no operator {}", quoted(token, file)),
                                    span};
            add_hint(result, file.text(span), previous, file);
            return result;
        }
        default: return explain_character(span, previous, file);
    }
}

}  // namespace etlc::parse
