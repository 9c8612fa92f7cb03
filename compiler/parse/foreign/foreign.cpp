#include "parse/foreign/foreign.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

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
          note_on_arguments(stuck, found, file), note_on_sign(stuck, found)}) {
        if (note.empty()) continue;
        to.note(note);
        return;
    }
}

}  // namespace etlc::parse
