#include "parse/foreign/foreign.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <initializer_list>

#include "EtlParser.h"

namespace etlc::parse {

using diag::Code;
using diag::Diagnostic;
using grammar::EtlParser;

namespace {

struct Row {
    Foreign kind;
    std::string_view written;
    std::string_view here;       ///< empty: there is no one word
    std::string_view note = "";  ///< empty: made of the word
};

constexpr std::array kRows{
#define FOREIGN_WORD(kind, written, here, note) Row{Foreign::kind, written, here, note},
#define OWN_WORD(kind, written, here)
#include "parse/foreign/words.def"
#undef FOREIGN_WORD
#undef OWN_WORD
};

/// Words of the language: they are meant in any case of their letters.
constexpr std::array kOwn{
#define FOREIGN_WORD(kind, written, here, note)
#define OWN_WORD(kind, written, here) Row{Foreign::kind, written, here, ""},
#include "parse/foreign/words.def"
#undef FOREIGN_WORD
#undef OWN_WORD
};

constexpr std::string_view kPrefixLetters = "FGXYOH";
constexpr std::string_view kInfixLetters = "UWRS";

std::string in_lower_case(std::string_view word) {
    std::string result(word);
    for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return result;
}

Native meant(std::string_view here) {
    return {std::string(here), fmt::format("did you mean '{}'?", here)};
}

template <std::size_t N>
std::optional<Native> found_in(const std::array<Row, N>& rows, Foreign kind,
                               std::string_view word) {
    const auto* const row = std::find_if(rows.begin(), rows.end(), [&](const Row& r) {
        return r.kind == kind && r.written == word;
    });
    if (row == rows.end()) return std::nullopt;
    if (row->note.empty()) return meant(row->here);
    return Native{std::string(row->here), std::string(row->note)};
}

/// F_ of F_[0,2], as in papers, and F_I; GF of GF p.
std::optional<Native> written_together(Foreign kind, std::string_view word) {
    const std::string_view letters = kind == Foreign::prefix ? kPrefixLetters : kInfixLetters;
    const std::string_view stem = word.substr(0, word.size() - 1);
    if (word.ends_with('_') && !stem.empty()) {
        const bool is_letter = stem.size() == 1 && letters.find(stem) != letters.npos;
        const auto foreign = found_in(kRows, kind, stem);
        if (!is_letter && !foreign && !found_in(kOwn, kind, stem)) return std::nullopt;
        const std::string here = foreign ? foreign->word : std::string(stem);
        return Native{here,
                      fmt::format("the interval stands behind the operator: {}[0, 2 s]", here)};
    }
    if (word.size() > 2 && word[1] == '_' && letters.find(word[0]) != letters.npos)
        return Native{"", fmt::format("the interval stands behind the operator: {}[0, 2 s]",
                                      word.substr(0, 1))};
    const bool only_letters = kind == Foreign::prefix && word.size() > 1 &&
                              word.find_first_not_of(kPrefixLetters) == word.npos;
    if (!only_letters) return std::nullopt;
    std::string apart(1, word[0]);
    for (const char letter : word.substr(1)) apart += fmt::format(" {}", letter);
    return Native{apart, fmt::format("a blank stands between operators: '{}'", apart)};
}

bool is(const Token* token, std::initializer_list<std::size_t> types) {
    return token != nullptr &&
           std::find(types.begin(), types.end(), token->getType()) != types.end();
}

bool is_prefix_operator(const Token* token) {
    return is(token, {EtlParser::EVENTUALLY, EtlParser::ALWAYS, EtlParser::ONCE,
                      EtlParser::HISTORICALLY, EtlParser::NEXT, EtlParser::PREVIOUS});
}

bool begins_operand(const Token& token) {
    return is_name(token) || is_prefix_operator(&token) ||
           is(&token, {EtlParser::NUMBER, EtlParser::TRUE, EtlParser::FALSE, EtlParser::LPAREN,
                       EtlParser::LBRACKET, EtlParser::NOT, EtlParser::MINUS});
}

bool in_formula(const Stuck& stuck) {
    switch (stuck.declaration) {
        case EtlParser::LET:
        case EtlParser::TRUTH:
        case EtlParser::MONITOR:
        case EtlParser::SLIDING:
        case EtlParser::RESTARTABLE:
        case EtlParser::REPEATING: return true;
        default: return false;
    }
}

Diagnostic no_operator(Code code, source::Span span, std::string_view written, const Native& here) {
    Diagnostic result{code, fmt::format("there is no operator '{}'", written), span, {}, 0, 0, {}};
    result.note(here.note).meant = here.word;
    return result;
}

/// The rule that the parser is in; names have one of their own.
std::size_t rule_of(const Stuck& stuck) {
    return stuck.rule == EtlParser::RuleName ? stuck.parent_rule : stuck.rule;
}

// ---- forms, each with what is to be said of it; empty: it is another

std::string note_on_interval(const Stuck& stuck, const Token& found, const source::File& file) {
    const auto is_found = [&](std::initializer_list<std::size_t> types) {
        return is(&found, types);
    };
    const bool compared = is_found(
        {EtlParser::LESS_EQUAL, EtlParser::LESS, EtlParser::GREATER_EQUAL, EtlParser::GREATER});
    if (compared && is_prefix_operator(stuck.previous))
        return fmt::format("an interval is written in brackets: {}[0, 2 s]",
                           text_of(*stuck.previous, file));
    const std::size_t rule = rule_of(stuck);
    if (rule == EtlParser::RuleBound || rule == EtlParser::RuleAmount) {
        if (is(stuck.previous, {EtlParser::LBRACKET}) &&
            (compared || is_found({EtlParser::COLON, EtlParser::COMMA})))
            return "both bounds are written: [0, 2 s], or [2 s, inf]";
        if (is(stuck.previous, {EtlParser::COMMA}) && is_found({EtlParser::RBRACKET}))
            return "without an upper bound it is [a, inf]";
    }
    if (rule != EtlParser::RuleInterval) return {};
    if (stuck.expected.contains(std::size_t{EtlParser::COMMA})) {
        if (is_found({EtlParser::RBRACKET}))
            return fmt::format("both bounds are written: [0, {}]", text_of(*stuck.previous, file));
        if (is_found(
                {EtlParser::COLON, EtlParser::MINUS, EtlParser::NUMBER, EtlParser::SEMICOLON}) ||
            text_of(found, file) == "to")
            return "a comma stands between the bounds: [0, 2 s]";
    }
    return is_found({EtlParser::RPAREN}) ? "an interval holds both its bounds: [a, b]" : "";
}

/// F(0, 2) p, and F[0, 2]s p.
std::string note_on_brackets(const Stuck& stuck, const Token& found, const source::File& file) {
    const bool number =
        is(stuck.previous, {EtlParser::NUMBER}) && is(stuck.before_previous, {EtlParser::LPAREN});
    if (number && is(&found, {EtlParser::COMMA}))
        return "an interval is written in square brackets: F[0, 2 s]";
    const bool unit = is(stuck.previous, {EtlParser::MICROSECONDS, EtlParser::MILLISECONDS,
                                          EtlParser::SECONDS, EtlParser::MIN, EtlParser::STEPS});
    if (unit && is(stuck.before_previous, {EtlParser::RBRACKET}) && in_formula(stuck))
        return fmt::format("the unit stands behind each bound: [0, 2 {}]",
                           text_of(*stuck.previous, file));
    return {};
}

std::string note_on_arguments(const Stuck& stuck, const Token& found, const source::File& file) {
    const std::size_t rule = rule_of(stuck);
    const bool fits = is(&found, {EtlParser::NUMBER}) && rule == EtlParser::RuleArgument;
    const std::string alpha = fits ? text_of(found, file) : "0.1";
    const bool whole = in_formula(stuck);
    if (rule == EtlParser::RuleArgument || rule == EtlParser::RuleCalibrated)
        return fmt::format(
            "calibration takes a method, and arguments by their names: "
            "calibrated(conformal, alpha = {}{})",
            alpha, whole ? ", against = missed_alarm" : "");
    if (rule == EtlParser::RuleFittedArgument || rule == EtlParser::RuleFitted)
        return "fitting takes a method, and arguments by their names: "
               "fitted(medoids, k = 8, of = z, where = f)";
    return {};
}

std::string note_on_sign(const Stuck& stuck, const Token& found) {
    if (is(&found, {EtlParser::COLON}) && rule_of(stuck) == EtlParser::RuleDeclaration &&
        stuck.expected.contains(std::size_t{EtlParser::ASSIGN}))
        return "'=' stands behind the name";
    if (stuck.declaration == EtlParser::INPUT && rule_of(stuck) == EtlParser::RuleDeclaration &&
        stuck.expected.contains(std::size_t{EtlParser::COLON}))
        return "the type stands behind the name: input x : f32;";
    if (!is(&found, {EtlParser::ASSIGN, EtlParser::COLON}) || stuck.previous == nullptr) return {};
    switch (stuck.previous->getType()) {
        case EtlParser::RATE: return "a rate has no '=': rate 10 Hz;";
        case EtlParser::PERIOD: return "a period has no '=': period 50 ms;";
        case EtlParser::SPEC: return "a file begins with 'spec NAME;'";
        case EtlParser::HOLD: return "'hold' has no '=': hold 3 steps";
        case EtlParser::SCALE: return "'scale' has no '=': scale 0.5";
        case EtlParser::MISSING: return "'missing' has no '=': missing false";
        case EtlParser::BY: return "'by' has no '=': by ENCODER";
        default: return {};
    }
}

}  // namespace

bool ends_operand(const Token* token) {
    return token != nullptr &&
           (is_name(*token) || is(token, {EtlParser::NUMBER, EtlParser::TRUE, EtlParser::FALSE,
                                          EtlParser::RPAREN, EtlParser::RBRACKET}));
}

std::optional<Native> native(Foreign kind, std::string_view word) {
    if (word.empty()) return std::nullopt;
    if (auto exact = found_in(kRows, kind, word)) return exact;
    if (auto together = written_together(kind, word)) return together;
    const std::string lower = in_lower_case(word);
    if (lower == word) return std::nullopt;
    if (auto own = found_in(kOwn, kind, lower)) return own;
    // A letter alone is another word in the other case.
    return lower.size() > 1 ? found_in(kRows, kind, lower) : std::nullopt;
}

std::optional<Diagnostic> foreign_operator(const Stuck& stuck, const Token& found,
                                           const source::File& file) {
    const Token* const before = stuck.previous;
    if (is(&found, {EtlParser::LBRACKET}) && is(stuck.following, {EtlParser::RBRACKET}) &&
        in_formula(stuck) && !ends_operand(before) && !is_prefix_operator(before)) {
        const source::Span both = source::join(span_of(found), span_of(*stuck.following));
        return no_operator(Code::unexpected_character, both, "[]", {"G", "'always' is 'G'"});
    }
    const bool follows_word = is(before, {EtlParser::IDENTIFIER}) && begins_operand(found) &&
                              !ends_operand(stuck.before_previous);
    const bool call = is(&found, {EtlParser::LPAREN}) && !in_formula(stuck);
    if (follows_word && !call && stuck.rule != EtlParser::RuleName) {
        const std::string word = text_of(*before, file);
        const auto here = native(Foreign::prefix, word);
        if (here) return no_operator(Code::unknown_keyword, span_of(*before), word, *here);
    }
    const bool follows_operand = is(&found, {EtlParser::IDENTIFIER}) && ends_operand(before);
    if (follows_operand && (in_formula(stuck) || stuck.rule == EtlParser::RulePrimary)) {
        const std::string word = text_of(found, file);
        const auto here = native(Foreign::infix, word);
        if (here) return no_operator(Code::unknown_keyword, span_of(found), word, *here);
    }
    return std::nullopt;
}

void add_note_on_foreign_form(const Stuck& stuck, const Token& found, const source::File& file,
                              Diagnostic& to) {
    if (stuck.previous == nullptr) return;
    if (is(stuck.previous, {EtlParser::NUMBER}) && is_name(found)) {
        if (const auto unit = native(Foreign::unit, text_of(found, file))) {
            to.note(unit->note);
            if (to.span == span_of(found)) to.meant = unit->word;
            return;
        }
    }
    if (rule_of(stuck) == EtlParser::RuleType && is_name(found)) {
        if (const auto type = native(Foreign::type, text_of(found, file))) {
            to.note(type->note);
            if (to.span == span_of(found)) to.meant = type->word;
            return;
        }
    }
    for (const std::string& note :
         {note_on_interval(stuck, found, file), note_on_brackets(stuck, found, file),
          note_on_arguments(stuck, found, file), note_on_sign(stuck, found)}) {
        if (note.empty()) continue;
        to.note(note);
        return;
    }
}

}  // namespace etlc::parse
