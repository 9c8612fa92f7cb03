#include "parse/expected.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <set>
#include <string_view>

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

/// Tokens that are named together where all of them are accepted.
struct Group {
    Types types;
    std::string words;
    bool closed;  ///< a closed list of keywords, so that another word is an unknown keyword
};

const std::vector<Group>& groups() {
    static const std::vector<Group> all{
        {{EtlParser::NUMBER, EtlParser::INF}, "a number or inf", false},
        {{EtlParser::LESS_EQUAL, EtlParser::NOT_EQUAL},
         "a comparison (<=, <, >=, >, == or !=)",
         false},
        {{EtlParser::F32, EtlParser::BOOL}, "a type (f32, f32[D], f16[D], i8[D] or bool)", true},
        {{EtlParser::DISTANCE, EtlParser::MAHALANOBIS},
         fmt::format("a distance ({})", diag::alternatives(distance_forms())),
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

bool has_all(const Stuck& stuck, const Types& types) {
    return std::all_of(types.begin(), types.end(),
                       [&stuck](std::size_t t) { return stuck.expects(t); });
}

bool expects_name(const Stuck& stuck) {
    return stuck.expects(EtlParser::IDENTIFIER);
}

bool expects_operand(const Stuck& stuck) {
    return expects_name(stuck) && stuck.expects(EtlParser::NUMBER) &&
           stuck.expects(EtlParser::LPAREN);
}

/// Formulas and expressions share rules; the tokens before the place tell which one was begun.
std::string operand_words(const Stuck& stuck) {
    if (is(stuck.previous, {EtlParser::LESS_EQUAL, EtlParser::LESS, EtlParser::GREATER_EQUAL,
                            EtlParser::GREATER, EtlParser::EQUAL, EtlParser::NOT_EQUAL}))
        return stuck.expects(EtlParser::CALIBRATED) && stuck.declaration == EtlParser::PREDICATE
                   ? "a threshold (a number, an expression or calibrated(...))"
                   : "a number or an expression";
    const bool in_call =
        is(stuck.previous, {EtlParser::COMMA}) ||
        (is(stuck.previous, {EtlParser::LPAREN}) &&
         is(stuck.before_previous,
            {EtlParser::ABS, EtlParser::SQRT, EtlParser::MIN, EtlParser::MAX, EtlParser::MEAN}));
    if (in_call || !stuck.expects(EtlParser::NOT)) return "an expression";
    const bool bracket = is(stuck.previous, {EtlParser::LPAREN});
    if (bracket && is(stuck.before_previous, {EtlParser::COUNT})) return "a formula";
    if (bracket && stuck.declaration == EtlParser::PREDICATE) return "an expression";
    return bracket ? "a formula or an expression" : "a formula";
}

std::string name_words(const Stuck& stuck) {
    switch (stuck.rule_around()) {
        case EtlParser::RulePoint:
            if (stuck.parent_rule == EtlParser::RuleDistance &&
                is(stuck.previous, {EtlParser::COMMA}))
                return "the name of a target, or another point";
            if (stuck.parent_rule == EtlParser::RulePoint &&
                !is(stuck.previous, {EtlParser::LPAREN}))
                return "a scalar input or a point";
            return "the name of an input or a projection, or a vector [x, y] of scalar inputs";
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

/// The parser tries operators after an operand in loops, so they are no longer in its expected set.
bool operators_could_follow(const Stuck& stuck) {
    if (stuck.rule == EtlParser::RulePrimary) return true;
    return stuck.rule == EtlParser::RuleDeclaration && stuck.in_formula() &&
           stuck.expects(EtlParser::SEMICOLON);
}

/// Tokens that messages name by their spelling.
constexpr std::array kSpelled = std::to_array<std::size_t>(
    {EtlParser::MONITOR,   EtlParser::IN,       EtlParser::HOLD,         EtlParser::MISSING,
     EtlParser::SCALE,     EtlParser::STALE,    EtlParser::AFTER,        EtlParser::OFFSET,
     EtlParser::FITTED,    EtlParser::FRAMES,   EtlParser::STRIDE,       EtlParser::OF,
     EtlParser::WHERE,     EtlParser::BY,       EtlParser::IMAGES,       EtlParser::IMAGE,
     EtlParser::DEVIATION, EtlParser::MEAN,     EtlParser::RESIZE,       EtlParser::FLIP,
     EtlParser::CHANNELS,  EtlParser::MARGINS,  EtlParser::PREPROCESSOR, EtlParser::OUTPUT,
     EtlParser::POOL,      EtlParser::ASSIGN,   EtlParser::LPAREN,       EtlParser::RPAREN,
     EtlParser::LBRACKET,  EtlParser::RBRACKET, EtlParser::COMMA,        EtlParser::COLON,
     EtlParser::SEMICOLON});

/// The parser reads lists in loops too, so another item is no longer expected where the list may
/// end.
bool another_item_could_follow(const Stuck& stuck) {
    switch (stuck.rule) {
        case EtlParser::RuleDeclaration: return stuck.expects(EtlParser::COLON);
        case EtlParser::RuleCalibrated:
        case EtlParser::RulePoint:
        case EtlParser::RuleLiteral:
        case EtlParser::RuleRow:
        case EtlParser::RuleLoad:
            return stuck.expects(EtlParser::RPAREN) || stuck.expects(EtlParser::RBRACKET);
        default: return false;
    }
}

/// Lists groups first, each token once, then the remaining tokens by their spelling.
std::vector<std::string> listed(const Stuck& stuck) {
    std::vector<std::string> words;
    std::set<std::size_t> covered{EtlParser::MINUS};  // begins a number
    if (expects_name(stuck))
        for (std::size_t type = EtlParser::IN; type <= EtlParser::IDENTIFIER; ++type)
            covered.insert(type);
    for (const Group& group : groups()) {
        const bool fresh = std::none_of(group.types.begin(), group.types.end(),
                                        [&](std::size_t t) { return covered.contains(t); });
        if (!fresh || !has_all(stuck, group.types)) continue;
        words.emplace_back(group.words);
        covered.insert(group.types.begin(), group.types.end());
    }
    for (const std::size_t type : kSpelled)
        if (stuck.expects(type) && !covered.contains(type))
            words.push_back(fmt::format("'{}'", keyword(type)));
    return words;
}

}  // namespace

std::string expected_words(const Stuck& stuck) {
    if (stuck.looked_ahead)
        return stuck.rule == EtlParser::RuleLiteral ? "a number, or a row [...] of numbers"
                                                    : "an operator";
    if (expects_operand(stuck)) return operand_words(stuck);
    // A name where a number is accepted is a constant, or the value of an argument.
    const bool in_argument =
        is(stuck.previous, {EtlParser::ASSIGN}) && stuck.rule != EtlParser::RuleDeclaration;
    if (in_argument && stuck.expects(EtlParser::NUMBER)) return "a number or a word";
    if (expects_name(stuck) && !stuck.expects(EtlParser::NUMBER)) return name_words(stuck);
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
        if (!stuck.expects(type)) continue;
        if (std::string word = keyword(type); !word.empty()) words.push_back(std::move(word));
    }
    if (operators_could_follow(stuck))
        for (const char* word : {"and", "or", "implies", "iff", "until", "weak_until", "release",
                                 "since", "calibrated"})
            words.emplace_back(word);
    if (stuck.rule == EtlParser::RuleDeclaration && stuck.declaration == EtlParser::INPUT)
        for (const char* word : {"by", "in", "hold", "scale", "missing", "stale", "after"})
            words.emplace_back(word);
    return words;
}

std::vector<std::string> distance_forms() {
    std::vector<std::string> forms = distance_words();
    std::replace(forms.begin(), forms.end(), std::string("mahalanobis"),
                 std::string("mahalanobis(M)"));
    return forms;
}

std::string description_of_reserved(std::size_t type) {
    const auto kind = operator_kind(type);
    if (!kind) return "a word of the language";
    const ast::Operator& op = *ast::operator_of(*kind);
    const bool is_letter = std::isalpha(static_cast<unsigned char>(op.symbol[0])) != 0;
    return fmt::format("the operator '{}'", is_letter ? op.word : op.symbol);
}

}  // namespace etlc::parse
