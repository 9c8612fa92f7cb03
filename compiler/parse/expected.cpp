#include "parse/expected.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "EtlParser.h"

namespace etlc::parse {

using grammar::EtlParser;

const std::vector<std::string>& distance_words() {
    static const std::vector<std::string> words{
#define DISTANCE(id, Type, prepared, zero_is_unknown) #id,
#define DISTANCE_BY_WEIGHTS(...)
#include "etlmon/distance/distances.def"
#undef DISTANCE
    };
    return words;
}

namespace {

using Types = std::vector<std::size_t>;

/// Tokens that are named together where all of them could stand.
struct Group {
    Types types;
    std::string words;
    bool closed;  ///< a list of keywords: another word in their place is an unknown one
};

const std::vector<Group>& groups() {
    static const std::vector<Group> all{
        {{EtlParser::NUMBER, EtlParser::INF}, "a number or inf", false},
        {{EtlParser::LESS_EQUAL, EtlParser::NOT_EQUAL},
         "a comparison (<=, <, >=, >, == or !=)",
         false},
        {{EtlParser::F32, EtlParser::BOOL}, "a type (f32, f32[D], f16[D], i8[D] or bool)", true},
        {{EtlParser::DISTANCE, EtlParser::MAHALANOBIS},
         fmt::format("a distance ({})", distances_in_words(" or ")),
         true},
        {{EtlParser::SECONDS, EtlParser::STEPS}, "a unit (us, ms, s, min or steps)", true},
        {{EtlParser::MICROSECONDS, EtlParser::SECONDS}, "a unit of time (us, ms, s or min)", true},
        {{EtlParser::HERTZ}, "'Hz'", true},
        {{EtlParser::DURATIONS}, "'durations'", true},
        {{EtlParser::UP, EtlParser::NEAREST}, "a way to round (up, down or nearest)", true},
        {{EtlParser::TRUE, EtlParser::FALSE}, "true or false", true},
        {{EtlParser::LOAD, EtlParser::LBRACKET}, "load(\"FILE\") or a matrix [[...], ...]", false},
        {{EtlParser::STRING}, "a file name between double quotes", false},
        {{EtlParser::NUMBER}, "a number", false},
    };
    return all;
}

bool has(const Stuck& stuck, std::size_t type) {
    return stuck.expected.contains(type);
}

bool has_all(const Stuck& stuck, const Types& types) {
    return std::all_of(types.begin(), types.end(),
                       [&stuck](std::size_t t) { return has(stuck, t); });
}

bool is_one_of(const Token* token, std::initializer_list<std::size_t> types) {
    return token != nullptr &&
           std::find(types.begin(), types.end(), token->getType()) != types.end();
}

bool expects_name(const Stuck& stuck) {
    return has(stuck, EtlParser::IDENTIFIER);
}

bool expects_operand(const Stuck& stuck) {
    return expects_name(stuck) && has(stuck, EtlParser::NUMBER) && has(stuck, EtlParser::LPAREN);
}

/// Formulas and expressions share rules; what stands before the place tells which of them was
/// begun.
std::string operand_words(const Stuck& stuck) {
    if (is_one_of(stuck.previous, {EtlParser::LESS_EQUAL, EtlParser::LESS, EtlParser::GREATER_EQUAL,
                                   EtlParser::GREATER, EtlParser::EQUAL, EtlParser::NOT_EQUAL}))
        return has(stuck, EtlParser::CALIBRATED) && stuck.declaration == EtlParser::PREDICATE
                   ? "a threshold (a number, an expression or calibrated(...))"
                   : "a number or an expression";
    const bool in_call = is_one_of(stuck.previous, {EtlParser::COMMA}) ||
                         (is_one_of(stuck.previous, {EtlParser::LPAREN}) &&
                          is_one_of(stuck.before_previous, {EtlParser::ABS, EtlParser::SQRT,
                                                            EtlParser::MIN, EtlParser::MAX}));
    if (in_call || !has(stuck, EtlParser::NOT)) return "an expression";
    const bool bracket = is_one_of(stuck.previous, {EtlParser::LPAREN});
    if (bracket && stuck.declaration == EtlParser::PREDICATE) return "an expression";
    return bracket ? "a formula or an expression" : "a formula";
}

std::string name_words(const Stuck& stuck) {
    switch (stuck.rule == EtlParser::RuleName ? stuck.parent_rule : stuck.rule) {
        case EtlParser::RuleDistance: return "the name of a target";
        case EtlParser::RulePoint:
            return has(stuck, EtlParser::LBRACKET)
                       ? "the name of an input or a projection, or a vector [x, y] of scalar inputs"
                       : "the name of a scalar input";
        case EtlParser::RuleWeights:
            return "load(\"FILE\"), a matrix, a diagonal [...], fitted(...) or the name of a "
                   "target";
        case EtlParser::RuleCalibrated:
            return "a method of calibration (f1, conformal or class_conditional)";
        case EtlParser::RuleFitted:
            return "a method of fitting (mean, medoids, kmeans, pca, whitened_pca, discriminant or "
                   "logpzo)";
        case EtlParser::RuleArgument: return "a word";
        default: return "a name";
    }
}

/// The operators that could follow an operand are tried by loops, so the parser does not expect
/// them any more.
bool operators_could_follow(const Stuck& stuck) {
    const bool in_formula =
        stuck.declaration == EtlParser::LET || stuck.declaration == EtlParser::TRUTH ||
        stuck.declaration == EtlParser::MONITOR || stuck.declaration == EtlParser::SLIDING ||
        stuck.declaration == EtlParser::RESTARTABLE || stuck.declaration == EtlParser::REPEATING;
    if (stuck.rule == EtlParser::RulePrimary) return true;
    return stuck.rule == EtlParser::RuleDeclaration && in_formula &&
           has(stuck, EtlParser::SEMICOLON);
}

std::string spelling(std::size_t type) {
    switch (type) {
        case EtlParser::ASSIGN: return "=";
        case EtlParser::LPAREN: return "(";
        case EtlParser::RPAREN: return ")";
        case EtlParser::LBRACKET: return "[";
        case EtlParser::RBRACKET: return "]";
        case EtlParser::COMMA: return ",";
        case EtlParser::COLON: return ":";
        case EtlParser::SEMICOLON: return ";";
        case EtlParser::MONITOR: return "monitor";
        case EtlParser::SCALE: return "scale";
        case EtlParser::IN: return "in";
        case EtlParser::HOLD: return "hold";
        case EtlParser::MISSING: return "missing";
        case EtlParser::OFFSET: return "offset";
        case EtlParser::FITTED: return "fitted";
        case EtlParser::FRAMES: return "frames";
        case EtlParser::STRIDE: return "stride";
        case EtlParser::BY: return "by";
        case EtlParser::IMAGES: return "images";
        case EtlParser::IMAGE: return "image";
        case EtlParser::MEAN: return "mean";
        case EtlParser::DEVIATION: return "deviation";
        case EtlParser::OF: return "of";
        case EtlParser::WHERE: return "where";
        default: return {};
    }
}

/// Lists are read by loops too, so another item is not expected any more where the list may end.
bool another_item_could_follow(const Stuck& stuck) {
    switch (stuck.rule) {
        case EtlParser::RuleDeclaration: return has(stuck, EtlParser::COLON);
        case EtlParser::RuleCalibrated:
        case EtlParser::RulePoint:
        case EtlParser::RuleLiteral:
        case EtlParser::RuleSetting:
        case EtlParser::RuleRow:
        case EtlParser::RuleLoad:
            return has(stuck, EtlParser::RPAREN) || has(stuck, EtlParser::RBRACKET);
        default: return false;
    }
}

bool contains(const std::vector<std::size_t>& types, std::size_t type) {
    return std::find(types.begin(), types.end(), type) != types.end();
}

/// Groups first, each token then once; the tokens left over by their spelling.
std::vector<std::string> listed(const Stuck& stuck) {
    std::vector<std::string> words;
    Types covered{EtlParser::MINUS};  // begins a number
    if (expects_name(stuck))
        for (std::size_t type = EtlParser::IN; type <= EtlParser::IDENTIFIER; ++type)
            covered.push_back(type);
    for (const Group& group : groups()) {
        const bool fresh = std::none_of(group.types.begin(), group.types.end(),
                                        [&covered](auto t) { return contains(covered, t); });
        if (!fresh || !has_all(stuck, group.types)) continue;
        words.emplace_back(group.words);
        covered.insert(covered.end(), group.types.begin(), group.types.end());
    }
    for (std::size_t type = EtlParser::SPEC; type <= EtlParser::SEMICOLON; ++type) {
        const std::string text = spelling(type);
        if (has(stuck, type) && !contains(covered, type) && !text.empty())
            words.push_back(fmt::format("'{}'", text));
    }
    return words;
}

}  // namespace

std::string expected_words(const Stuck& stuck) {
    if (stuck.looked_ahead)
        return stuck.rule == EtlParser::RuleLiteral ? "a number, or a row [...] of numbers"
                                                    : "an operator";
    if (expects_operand(stuck)) return operand_words(stuck);
    // A name that stands where a number can is that of a constant, or a word of an argument.
    const bool in_argument =
        is_one_of(stuck.previous, {EtlParser::ASSIGN}) && stuck.rule != EtlParser::RuleDeclaration;
    if (in_argument && has(stuck, EtlParser::NUMBER)) return "a number or a word";
    if (expects_name(stuck) && !has(stuck, EtlParser::NUMBER)) return name_words(stuck);
    std::vector<std::string> words = listed(stuck);
    if (operators_could_follow(stuck)) words.insert(words.begin(), "an operator");
    if (another_item_could_follow(stuck)) words.emplace_back("','");
    return words.empty() ? "something else" : diag::alternatives(words);
}

bool expects_keyword(const Stuck& stuck) {
    if (expects_name(stuck)) return false;
    return std::any_of(groups().begin(), groups().end(),
                       [&stuck](const Group& g) { return g.closed && has_all(stuck, g.types); });
}

std::vector<std::string> expected_spellings(const Stuck& stuck) {
    std::vector<std::string> words;
    for (std::size_t type = EtlParser::SPEC; type <= EtlParser::SQRT; ++type) {
        if (!has(stuck, type)) continue;
        std::string literal = stuck.vocabulary->getLiteralName(type);
        literal.erase(std::remove(literal.begin(), literal.end(), '\''), literal.end());
        if (!literal.empty()) words.push_back(std::move(literal));
    }
    if (operators_could_follow(stuck))
        for (const char* word : {"and", "or", "implies", "iff", "until", "weak_until", "release",
                                 "since", "calibrated"})
            words.emplace_back(word);
    if (stuck.rule == EtlParser::RuleDeclaration && stuck.declaration == EtlParser::INPUT)
        for (const char* word : {"by", "in", "hold", "scale", "missing"}) words.emplace_back(word);
    return words;
}

std::string distances_in_words(std::string_view before_last) {
    const std::vector<std::string>& words = distance_words();
    std::string text;
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (i > 0) text += i + 1 < words.size() ? ", " : before_last;
        text += words[i];
        if (words[i] == "mahalanobis") text += "(M)";
    }
    return text;
}

const std::vector<std::string>& callable_words() {
    static const std::vector<std::string> words = [] {
        std::vector<std::string> all = distance_words();
        for (const char* function : {"abs", "sqrt", "min", "max", "kth"})
            all.emplace_back(function);
        return all;
    }();
    return words;
}

std::string description_of_reserved(std::size_t type) {
    switch (type) {
        case EtlParser::IFF: return "the operator '<->'";
        case EtlParser::IMPLIES: return "the operator '->'";
        case EtlParser::OR: return "the operator '||'";
        case EtlParser::AND: return "the operator '&&'";
        case EtlParser::NOT: return "the operator '!'";
        case EtlParser::UNTIL: return "the operator 'until'";
        case EtlParser::WEAK_UNTIL: return "the operator 'weak_until'";
        case EtlParser::RELEASE: return "the operator 'release'";
        case EtlParser::SINCE: return "the operator 'since'";
        case EtlParser::NEXT: return "the operator 'next'";
        case EtlParser::EVENTUALLY: return "the operator 'eventually'";
        case EtlParser::ALWAYS: return "the operator 'always'";
        case EtlParser::PREVIOUS: return "the operator 'previous'";
        case EtlParser::ONCE: return "the operator 'once'";
        case EtlParser::HISTORICALLY: return "the operator 'historically'";
        default: return "a word of the language";
    }
}

}  // namespace etlc::parse
