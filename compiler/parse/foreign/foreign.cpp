#include "parse/foreign/foreign.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <string_view>

#include "EtlLexer.h"
#include "source/text.hpp"

namespace etlc::parse {

using diag::Code;
using diag::Diagnostic;
using grammar::EtlParser;

namespace {

struct Row {
    Foreign kind;
    std::string_view written;    ///< synonyms, separated by blanks
    std::string_view here;       ///< empty if no single word replaces it
    std::string_view note = "";  ///< empty: "did you mean 'HERE'?"
};

constexpr std::array kRows{
#define FOREIGN_WORDS(kind, written, here, note) Row{Foreign::kind, written, here, note},
#include "parse/foreign/words.def"
#undef FOREIGN_WORDS
};

constexpr std::string_view kPrefixLetters = "FGXYOH";
constexpr std::string_view kInfixLetters = "UWRS";

std::string in_lower_case(std::string_view word) {
    std::string result(word);
    for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return result;
}

Native replacement(std::string_view here) {
    return {std::string(here), fmt::format("did you mean '{}'?", here)};
}

std::optional<Native> foreign_word(Foreign kind, std::string_view word) {
    const auto* const row = std::find_if(kRows.begin(), kRows.end(), [&](const Row& r) {
        return r.kind == kind && is_listed(r.written, word);
    });
    if (row == kRows.end()) return std::nullopt;
    if (row->note.empty()) return replacement(row->here);
    return Native{std::string(row->here), std::string(row->note)};
}

/// Finds a word of the language in lower case.
std::optional<Native> own_word(Foreign kind, std::string_view lower) {
    for (const ast::Operator& op : ast::kOperators)
        if (kind == (op.level == ast::kPrefix ? Foreign::prefix : Foreign::infix) &&
            op.word == lower)
            return replacement(op.symbol);
    for (const std::string& word : own_words(kind))
        if (in_lower_case(word) == lower) return replacement(word);
    return std::nullopt;
}

/// Explains F_ in F_[0,2] and F_I, as in papers, and GF in GF p.
std::optional<Native> written_together(Foreign kind, std::string_view word) {
    const std::string_view letters = kind == Foreign::prefix ? kPrefixLetters : kInfixLetters;
    const std::string_view stem = word.substr(0, word.size() - 1);
    if (word.ends_with('_') && !stem.empty()) {
        const bool is_letter = stem.size() == 1 && letters.find(stem) != letters.npos;
        const auto foreign = foreign_word(kind, stem);
        if (!is_letter && !foreign && !own_word(kind, stem)) return std::nullopt;
        const std::string here = foreign ? foreign->word : std::string(stem);
        return Native{here, fmt::format("the interval follows the operator: {}[0, 2 s]", here)};
    }
    if (word.size() > 2 && word[1] == '_' && letters.find(word[0]) != letters.npos)
        return Native{
            "", fmt::format("the interval follows the operator: {}[0, 2 s]", word.substr(0, 1))};
    const bool only_letters = kind == Foreign::prefix && word.size() > 1 &&
                              word.find_first_not_of(kPrefixLetters) == word.npos;
    if (!only_letters) return std::nullopt;
    std::string apart(1, word[0]);
    for (const char letter : word.substr(1)) apart += fmt::format(" {}", letter);
    return Native{apart, fmt::format("operators are separated by blanks: '{}'", apart)};
}

bool is_prefix_operator(const Token* token) {
    return is(token, {EtlParser::EVENTUALLY, EtlParser::ALWAYS, EtlParser::ONCE,
                      EtlParser::HISTORICALLY, EtlParser::NEXT, EtlParser::PREVIOUS});
}

Diagnostic no_operator(Code code, source::Span span, std::string_view written, const Native& here) {
    Diagnostic result{code, fmt::format("there is no operator '{}'", written), span};
    result.note(here.note).meant = here.word;
    return result;
}

// ---- notes on forms; empty if the form is another

std::string note_on_interval(const Stuck& stuck, const Token& found, const source::File& file) {
    const auto is_found = [&](std::initializer_list<std::size_t> types) {
        return is(&found, types);
    };
    const bool compared = is_found(
        {EtlParser::LESS_EQUAL, EtlParser::LESS, EtlParser::GREATER_EQUAL, EtlParser::GREATER});
    if (compared && is_prefix_operator(stuck.previous))
        return fmt::format("an interval is written in brackets: {}[0, 2 s]",
                           text_of(*stuck.previous, file));
    const std::size_t rule = stuck.rule_around();
    if (rule == EtlParser::RuleBound || rule == EtlParser::RuleAmount) {
        if (is(stuck.previous, {EtlParser::LBRACKET}) &&
            (compared || is_found({EtlParser::COLON, EtlParser::COMMA})))
            return "an interval needs both bounds: [0, 2 s], or [2 s, inf]";
        if (is(stuck.previous, {EtlParser::COMMA}) && is_found({EtlParser::RBRACKET}))
            return "without an upper bound, write [a, inf]";
    }
    if (rule != EtlParser::RuleInterval) return {};
    if (stuck.expects(EtlParser::COMMA)) {
        if (is_found({EtlParser::RBRACKET}))
            return fmt::format("an interval needs both bounds: [0, {}]",
                               text_of(*stuck.previous, file));
        if (is_found(
                {EtlParser::COLON, EtlParser::MINUS, EtlParser::NUMBER, EtlParser::SEMICOLON}) ||
            text_of(found, file) == "to")
            return "bounds are separated by a comma: [0, 2 s]";
    }
    return is_found({EtlParser::RPAREN}) ? "an interval includes both bounds: [a, b]" : "";
}

/// Explains F(0, 2) p and F[0, 2]s p.
std::string note_on_brackets(const Stuck& stuck, const Token& found, const source::File& file) {
    const bool number =
        is(stuck.previous, {EtlParser::NUMBER}) && is(stuck.before_previous, {EtlParser::LPAREN});
    if (number && is(&found, {EtlParser::COMMA}))
        return "an interval is written in square brackets: F[0, 2 s]";
    const bool unit = is(stuck.previous, {EtlParser::MICROSECONDS, EtlParser::MILLISECONDS,
                                          EtlParser::SECONDS, EtlParser::MIN, EtlParser::STEPS});
    if (unit && is(stuck.before_previous, {EtlParser::RBRACKET}) && stuck.in_formula())
        return fmt::format("the unit follows the bound: [0, 2 {}]", text_of(*stuck.previous, file));
    return {};
}

std::string note_on_arguments(const Stuck& stuck, const Token& found, const source::File& file) {
    const std::size_t rule = stuck.rule_around();
    const bool fits = is(&found, {EtlParser::NUMBER}) && rule == EtlParser::RuleArgument;
    const std::string alpha = fits ? text_of(found, file) : "0.1";
    const bool whole = stuck.in_formula();
    if (rule == EtlParser::RuleArgument || rule == EtlParser::RuleCalibrated)
        return fmt::format(
            "calibration needs a method and named arguments: calibrated(conformal, alpha = {}{})",
            alpha, whole ? ", against = missed_alarm" : "");
    if (rule == EtlParser::RuleFittedArgument || rule == EtlParser::RuleFitted)
        return "fitting needs a method and named arguments: fitted(medoids, k = 8, of = z, where = "
               "f)";
    return {};
}

std::string note_on_calibrated(const Token& found) {
    if (!is(&found, {EtlParser::CALIBRATED})) return {};
    return "calibration finds the threshold of a predicate, or one time of a monitor: the upper "
           "bound "
           "of an interval, or that of held or count; no guarantee follows from a calibrated "
           "delay, "
           "window, hold or stale time";
}

std::string note_on_sign(const Stuck& stuck, const Token& found) {
    if (is(&found, {EtlParser::COLON}) && stuck.rule_around() == EtlParser::RuleDeclaration &&
        stuck.expects(EtlParser::ASSIGN))
        return "'=' follows the name";
    if (stuck.declaration == EtlParser::INPUT &&
        stuck.rule_around() == EtlParser::RuleDeclaration && stuck.expects(EtlParser::COLON))
        return "the type follows the name: input x : f32;";
    if (stuck.declaration == EtlParser::INPUT && is(&found, {EtlParser::STALE}) &&
        stuck.expects(EtlParser::SEMICOLON))
        return "'stale after' follows a comma: input x : f32, stale after 5;";
    if (stuck.declaration == EtlParser::INPUT && is(stuck.previous, {EtlParser::COMMA}) &&
        stuck.rule_around() == EtlParser::RuleStale)
        return "only 'stale after' follows a comma: input x : f32 hold 2, stale after 5;";
    if (!is(&found, {EtlParser::ASSIGN, EtlParser::COLON}) || stuck.previous == nullptr) return {};
    switch (stuck.previous->getType()) {
        case EtlParser::RATE: return "a rate has no '=': rate 10 Hz;";
        case EtlParser::PERIOD: return "a period has no '=': period 50 ms;";
        case EtlParser::SPEC: return "a file begins with 'spec NAME;'";
        case EtlParser::HOLD: return "'hold' has no '=': hold 3 steps";
        case EtlParser::STALE: return "after 'stale' comes 'after': stale after 5";
        case EtlParser::AFTER: return "'stale after' has no '=': stale after 5";
        case EtlParser::SCALE: return "'scale' has no '=': scale 0.5";
        case EtlParser::MISSING: return "'missing' has no '=': missing false";
        case EtlParser::BY: return "'by' has no '=': by ENCODER";
        default: return {};
    }
}

}  // namespace

bool is_listed(std::string_view list, std::string_view word) {
    while (!list.empty()) {
        const std::size_t end = std::min(list.find(' '), list.size());
        if (list.substr(0, end) == word) return true;
        list.remove_prefix(std::min(end + 1, list.size()));
    }
    return false;
}

std::vector<std::string> own_words(Foreign kind) {
    switch (kind) {
        case Foreign::unit: return {"us", "ms", "s", "min", "Hz", "steps"};
        case Foreign::type: return {"f32", "f16", "i8", "bool"};
        case Foreign::declaration:
            return {"spec",  "rate",       "period",  "const",       "encoder",
                    "input", "projection", "target",  "predicate",   "truth",
                    "let",   "monitor",    "sliding", "restartable", "repeating"};
        default: return {};
    }
}

std::optional<Native> native(Foreign kind, std::string_view word) {
    if (word.empty()) return std::nullopt;
    if (auto exact = foreign_word(kind, word)) return exact;
    if (auto together = written_together(kind, word)) return together;
    const std::string lower = in_lower_case(word);
    if (lower == word) return std::nullopt;
    if (auto own = own_word(kind, lower)) return own;
    // A single letter means something else in the other case.
    return lower.size() > 1 ? foreign_word(kind, lower) : std::nullopt;
}

std::optional<Diagnostic> foreign_operator(const Stuck& stuck, const Token& found,
                                           const source::File& file) {
    const Token* const before = stuck.previous;
    if (is(&found, {EtlParser::LBRACKET}) && is(stuck.following, {EtlParser::RBRACKET}) &&
        stuck.in_formula() && !ends_operand(before) && !is_prefix_operator(before)) {
        const source::Span both = source::join(span_of(found), span_of(*stuck.following));
        return no_operator(Code::unexpected_character, both, "[]", {"G", "'always' is 'G'"});
    }
    const bool follows_word =
        is(before, {EtlParser::IDENTIFIER}) &&
        (begins_operand(found) || is(&found, {EtlParser::LBRACKET, EtlParser::MINUS})) &&
        !ends_operand(stuck.before_previous);
    const bool call = is(&found, {EtlParser::LPAREN}) && !stuck.in_formula();
    if (follows_word && !call && stuck.rule != EtlParser::RuleName) {
        const std::string word = text_of(*before, file);
        const auto here = native(Foreign::prefix, word);
        if (here) return no_operator(Code::unknown_keyword, span_of(*before), word, *here);
    }
    const bool follows_operand = is(&found, {EtlParser::IDENTIFIER}) && ends_operand(before);
    if (follows_operand && (stuck.in_formula() || stuck.rule == EtlParser::RulePrimary)) {
        const std::string word = text_of(found, file);
        const auto here = native(Foreign::infix, word);
        if (here) return no_operator(Code::unknown_keyword, span_of(found), word, *here);
    }
    return std::nullopt;
}

void add_note_on_foreign_form(const Stuck& stuck, const Token& found, const source::File& file,
                              Diagnostic& to) {
    if (stuck.previous == nullptr) return;
    const bool unit = is(stuck.previous, {EtlParser::NUMBER});
    if (is_name(found) && (unit || stuck.rule_around() == EtlParser::RuleType)) {
        const std::string word = text_of(found, file);
        auto here = unit ? native(Foreign::unit, word) : std::nullopt;
        if (!here && stuck.rule_around() == EtlParser::RuleType) here = native(Foreign::type, word);
        if (here) {
            to.note(here->note);
            if (to.span == span_of(found)) to.meant = here->word;
            return;
        }
    }
    for (const std::string& note :
         {note_on_interval(stuck, found, file), note_on_brackets(stuck, found, file),
          note_on_arguments(stuck, found, file), note_on_sign(stuck, found),
          note_on_calibrated(found)}) {
        if (note.empty()) continue;
        to.note(note);
        return;
    }
}

// Explains mistaken tokens: characters, numbers and operators that the language does not have.

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
