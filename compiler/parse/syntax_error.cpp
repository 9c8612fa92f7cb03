#include "parse/syntax_error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <set>
#include <string_view>

#include "parse/foreign/foreign.hpp"

namespace etlc::parse {

using diag::Code;
using diag::Diagnostic;
using grammar::EtlParser;

namespace {

const std::vector<std::string>& units() {
    static const std::vector<std::string> all{"us", "ms", "s", "min", "steps"};
    return all;
}

bool is_aggregation(const Token* token) {
    return is(token, {EtlParser::MIN, EtlParser::MAX, EtlParser::MEAN});
}

/// Composes the diagnostic for one place.
class Explanation {
public:
    Explanation(const Stuck& stuck, const Token& found, const source::File& file)
        : stuck_(stuck), found_(found), file_(file) {}

    Diagnostic make() {
        if (stuck_.previous == nullptr) return no_declaration();
        if (reserved_as_name()) return reserved();
        if (auto foreign = foreign_operator(stuck_, found_, file_)) return std::move(*foreign);
        if (unknown_call()) return no_such_callable();
        if (interval_misplaced()) return no_interval();
        if (unknown_unit()) return no_such_unit();
        Diagnostic result = expected_found();
        add_notes(result);
        return result;
    }

private:
    std::string text(const Token& token) const { return text_of(token, file_); }

    bool found_is_word() const { return found_.getType() == EtlParser::IDENTIFIER; }

    /// Returns the place of something missing: after the last word on its line rather than before
    /// the first word on the next.
    source::Span place() const {
        const source::Span found = span_of(found_);
        if (stuck_.previous == nullptr) return found;
        const std::uint32_t end = span_of(*stuck_.previous).end;
        const bool next_line = file_.position(end).line != file_.position(found.begin).line;
        return next_line || slice_ended() ? source::Span{end, end} : found;
    }

    void add_nearest(Diagnostic& to, const Token& word,
                     const std::vector<std::string>& candidates) const {
        const auto nearest = diag::nearest_name(text(word), candidates);
        if (!nearest) return;
        diag::did_you_mean(to, *nearest);
        if (to.span != span_of(word)) to.meant.clear();
    }

    /// Explains a word of another language, if it is one.
    bool add_native(Diagnostic& to, Foreign kind, const Token& word) const {
        auto here = native(kind, text(word));
        if (!here) return false;
        to.note(std::move(here->note));
        if (to.span == span_of(word)) to.meant = std::move(here->word);
        return true;
    }

    Diagnostic no_declaration() const {
        const bool word = found_is_word();
        Diagnostic result{word ? Code::unknown_keyword : Code::syntax_error,
                          fmt::format("expected a declaration, found {}", quoted(found_, file_)),
                          span_of(found_)};
        if (word && !add_native(result, Foreign::declaration, found_))
            add_nearest(result, found_, own_words(Foreign::declaration));
        if (is(&found_, {EtlParser::NOT, EtlParser::NEXT, EtlParser::EVENTUALLY, EtlParser::ALWAYS,
                         EtlParser::PREVIOUS, EtlParser::ONCE, EtlParser::HISTORICALLY,
                         EtlParser::LPAREN, EtlParser::LBRACKET}))
            result.note("a formula needs a name: monitor NAME = FORMULA;");
        if (result.notes.empty())
            result.note(
                "a declaration begins with spec, rate, period, const, encoder, input, projection, "
                "target, predicate, truth, let or monitor; sliding, restartable and repeating come "
                "before monitor");
        return result;
    }

    bool reserved_as_name() const {
        return stuck_.rule == EtlParser::RuleName &&
               stuck_.parent_rule == EtlParser::RuleDeclaration && is_reserved_word(found_, file_);
    }

    Diagnostic reserved() const {
        Diagnostic result{Code::reserved_name,
                          fmt::format("{} is reserved and cannot be a name", quoted(found_, file_)),
                          span_of(found_)};
        result.note(fmt::format("{} is {}; choose another name", quoted(found_, file_),
                                description_of_reserved(found_.getType())));
        return result;
    }

    /// Whether a word before '(' is neither a distance nor a function, or a word after an
    /// aggregation is no distance.
    bool unknown_call() const {
        if (is_aggregation(stuck_.previous) && found_is_word()) return true;
        const bool after_operand = stuck_.rule == EtlParser::RulePrimary ||
                                   stuck_.rule == EtlParser::RuleDeclaration ||
                                   stuck_.rule == EtlParser::RuleComparisonOperator;
        const bool declared_name = is(stuck_.before_previous, {stuck_.declaration});
        return found_.getType() == EtlParser::LPAREN && is_name(*stuck_.previous) &&
               after_operand && !declared_name;
    }

    Diagnostic no_such_callable() const {
        const bool aggregated = is_aggregation(stuck_.previous);
        const Token& word = aggregated ? found_ : *stuck_.previous;
        Diagnostic result{
            Code::unknown_keyword,
            aggregated
                ? fmt::format("expected a distance after {}, found {}",
                              quoted(*stuck_.previous, file_), quoted(word, file_))
                : fmt::format("{} is neither a distance nor a function", quoted(word, file_)),
            span_of(word)};
        std::vector<std::string> callables = distance_words();
        callables.insert(callables.end(),
                         {"abs", "sqrt", "min", "max", "mean", "count", "fraction", "kth"});
        if (word.getType() == EtlParser::IDENTIFIER && !add_native(result, Foreign::callable, word))
            add_nearest(result, word, callables);
        if (result.notes.empty())
            result.note(
                fmt::format("distances: {}; functions: abs, sqrt, min, max, mean, count, fraction",
                            fmt::join(distance_forms(), ", ")));
        return result;
    }

    bool interval_misplaced() const {
        return found_.getType() == EtlParser::LBRACKET &&
               is(stuck_.previous,
                  {EtlParser::NEXT, EtlParser::PREVIOUS, EtlParser::RISE, EtlParser::FALL,
                   EtlParser::WEAK_UNTIL, EtlParser::NOT, EtlParser::AND, EtlParser::OR,
                   EtlParser::IMPLIES, EtlParser::IFF});
    }

    Diagnostic no_interval() const {
        Diagnostic result{Code::syntax_error,
                          fmt::format("{} takes no interval", quoted(*stuck_.previous, file_)),
                          span_of(found_)};
        result.note("only F, G, O, H, U, R and S take intervals");
        return result;
    }

    /// A word after a bound is a unit if the interval continues after it or it resembles a unit;
    /// otherwise the interval should have ended before it, as in "F[0, 5 q".
    bool unknown_unit() const {
        const bool word = is_name(found_) || is_reserved_word(found_, file_);
        if (!is(stuck_.previous, {EtlParser::NUMBER}) || !word) return false;
        if (stuck_.declaration == EtlParser::CONST) return true;
        if (stuck_.rule != EtlParser::RuleInterval && stuck_.rule != EtlParser::RuleDuration)
            return false;
        return is(stuck_.following, {EtlParser::COMMA, EtlParser::RBRACKET}) ||
               native(Foreign::unit, text(found_)) || diag::nearest_name(text(found_), units());
    }

    Diagnostic no_such_unit() const {
        Diagnostic result{
            Code::unknown_keyword,
            fmt::format("expected a unit (us, ms, s, min or steps) after {}, found {}",
                        quoted(*stuck_.previous, file_), quoted(found_, file_)),
            span_of(found_)};
        if (!add_native(result, Foreign::unit, found_)) add_nearest(result, found_, units());
        return result;
    }

    Diagnostic expected_found() const {
        const bool unknown = found_is_word() && expects_keyword(stuck_);
        return {unknown ? Code::unknown_keyword : Code::syntax_error,
                fmt::format("expected {} after {}, found {}", expected_words(stuck_),
                            quoted(*stuck_.previous, file_), quoted(found_, file_)),
                place()};
    }

    void add_notes(Diagnostic& to) const {
        add_note_on_foreign_form(stuck_, found_, file_, to);
        if (to.notes.empty() && found_is_word() && stuck_.rule != EtlParser::RuleName)
            add_nearest(to, found_, expected_spellings(stuck_));
        for (const std::string& note : {note_on_words(), note_on_rule()})
            if (to.notes.empty() && !note.empty()) to.note(note);
        if (slice_ended() && to.meant.empty() && stuck_.expects(EtlParser::SEMICOLON))
            to.meant = ";";
    }

    /// Returns the note that the words around the place suggest, or nothing.
    std::string note_on_words() const {
        const std::size_t found = found_.getType();
        const bool in_brackets =
            stuck_.rule == EtlParser::RulePrimary && stuck_.expects(EtlParser::COMMA);
        if (found == EtlParser::INF) return "inf is allowed only in bounds of intervals and ranges";
        if (found == EtlParser::ASSIGN && stuck_.rule != EtlParser::RuleName)
            return "comparisons are '<=', '<', '>=', '>', '==' and '!='";
        if (found == EtlParser::RPAREN && in_brackets)
            return "min(...) and max(...) need two or more expressions or, as mean(...), one and a "
                   "time: mean(x, 2 s); over a target set, write 'min l2(z, goal)'";
        if (is(stuck_.previous, {EtlParser::KTH}))
            return "kth takes its rank in brackets: kth(3) l2(z, goal)";
        if (!is_reserved_word(found_, file_) || !stuck_.expects(EtlParser::IDENTIFIER) ||
            slice_ended())
            return "";
        return fmt::format("{} is reserved: it is {}", quoted(found_, file_),
                           description_of_reserved(found));
    }

    /// Returns the note on how the current construct is written, or nothing.
    std::string note_on_rule() const {
        if (stuck_.rule == EtlParser::RuleDuration ||
            stuck_.parent_rule == EtlParser::RuleDuration || is(stuck_.previous, {EtlParser::HELD}))
            return "'held' takes a single duration: held[20 steps] f, held[2 s] f";
        switch (stuck_.rule) {
            case EtlParser::RuleDimension:
                return "only f32 and bool can be scalars; an embedding has its dimension in "
                       "brackets";
            case EtlParser::RuleMetric:
            case EtlParser::RuleWeights: return "the weights come first: mahalanobis(M)(z, goal)";
            case EtlParser::RuleInterval:
            case EtlParser::RuleBound:
                return "an interval is written [a, b] or [a, inf], in steps or with units of time: "
                       "[0, 20 steps], [0s, 2s]";
            case EtlParser::RuleThreshold:
                return "the expression is on the left, its threshold on the right: x - y <= 0.5";
            case EtlParser::RuleComparisonOperator:
                return stuck_.declaration == EtlParser::PREDICATE
                           ? "a predicate compares one expression with a threshold; a formula is "
                             "named with 'let'"
                           : "";
            default: return "";
        }
    }

    bool slice_ended() const { return stuck_.found->getType() == Token::EOF; }

    const Stuck& stuck_;
    const Token& found_;
    const source::File& file_;
};

}  // namespace

SyntaxError explain(const Stuck& stuck, const Token& next, const source::File& file) {
    const Token& found = stuck.found->getType() == Token::EOF ? next : *stuck.found;
    const std::string previous =
        stuck.previous != nullptr ? text_of(*stuck.previous, file) : std::string();
    return {Explanation(stuck, found, file).make(), text_of(found, file), previous};
}

void Strategy::stop(antlr4::Parser* parser, const Token* found) {
    const auto index = [this](const Token* token) {
        // Tokens of a slice are in the order of their offsets.
        std::size_t i = slice_.begin;
        while (i < slice_.end && tokens_[i].get() != token) ++i;
        return i;
    };
    const std::size_t at = index(found);
    const auto before = [this, at](std::size_t n) {
        return at >= slice_.begin + n ? tokens_[at - n].get() : nullptr;
    };
    const antlr4::ParserRuleContext* const context = parser->getContext();
    const auto* parent = dynamic_cast<const antlr4::ParserRuleContext*>(context->parent);
    // A point may be a sum, and what is around it matters.
    if (context->getRuleIndex() == EtlParser::RuleLocated)
        parent = dynamic_cast<const antlr4::ParserRuleContext*>(parent->parent);
    const Stuck stuck{found,
                      before(1),
                      before(2),
                      at + 1 < slice_.end ? tokens_[at + 1].get() : nullptr,
                      parser->getExpectedTokens(),
                      context->getRuleIndex(),
                      parent != nullptr ? parent->getRuleIndex() : context->getRuleIndex(),
                      tokens_[slice_.begin]->getType(),
                      found != parser->getCurrentToken()};
    throw explain(stuck, *tokens_[slice_.end], file_);
}

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
    if (bracket && is(stuck.before_previous, {EtlParser::COUNT, EtlParser::FRACTION}))
        return "a formula";
    if (bracket && stuck.declaration == EtlParser::PREDICATE) return "an expression";
    return bracket ? "a formula or an expression" : "a formula";
}

std::string name_words(const Stuck& stuck) {
    switch (stuck.rule_around()) {
        case EtlParser::RuleLocated:
            if (stuck.parent_rule == EtlParser::RuleDistance &&
                is(stuck.previous, {EtlParser::COMMA}))
                return "the name of a target, or another point";
            if (stuck.parent_rule == EtlParser::RuleLocated &&
                !is(stuck.previous, {EtlParser::LPAREN}))
                return "a scalar input or a point";
            return "the name of an input or a projection, or a vector [x, y] of scalar inputs";
        case EtlParser::RuleWeights:
            return "load(\"FILE\"), a matrix, a diagonal [...], fitted(...) or the name of a "
                   "target";
        case EtlParser::RuleCalibrated:
            return "a method of calibration (conformal, risk, class_conditional or f1)";
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
        case EtlParser::RuleLocated:
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
    if (stuck.rule == EtlParser::RulePoint) return "'*' and a point";  // after a number
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
