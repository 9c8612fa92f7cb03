#include "parse/continuations.hpp"

#include <algorithm>

#include "EtlLexer.h"
#include "EtlParser.h"
#include "parse/stream/tokens.hpp"
#include "parse/syntax_error.hpp"

namespace etlc::parse {

using grammar::EtlLexer;
using grammar::EtlParser;

namespace {

/// Longer declarations are matrices, and the parser reads the tokens once for each word.
constexpr std::size_t kMostTokens = 2000;

/// Thrown where the parser cannot go on.
struct Stopped {
    const Token* at;
};

class Stop final : public StopAtError {
    void stop(antlr4::Parser* /*parser*/, const Token* found) override { throw Stopped{found}; }
};

/// Records the rules in which the last token was taken.
class Watch final : public antlr4::tree::ParseTreeListener {
public:
    explicit Watch(const Token* last) : last_(last) {}

    void visitTerminal(antlr4::tree::TerminalNode* node) override {
        if (node->getSymbol() != last_) return;
        for (auto* at = node->parent; at != nullptr; at = at->parent)
            rules_.push_back(dynamic_cast<antlr4::ParserRuleContext*>(at)->getRuleIndex());
    }
    void visitErrorNode(antlr4::tree::ErrorNode* /*node*/) override {}
    void enterEveryRule(antlr4::ParserRuleContext* /*context*/) override {}
    void exitEveryRule(antlr4::ParserRuleContext* /*context*/) override {}

    /// Innermost first; empty if the parser did not reach the token because it needs to see more.
    const std::vector<std::size_t>& rules() const { return rules_; }

private:
    const Token* last_;
    std::vector<std::size_t> rules_;
};

/// Asks the parser whether it accepts a token after those of an unfinished declaration.
class Probe {
public:
    Probe(Tokens tokens, std::size_t end_offset) : tokens_(std::move(tokens)) {
        first_ = add(EtlLexer::IDENTIFIER, end_offset);
        second_ = add(EtlLexer::IDENTIFIER, end_offset);
        add(Token::EOF, end_offset);
    }

    bool is_too_deep() const { return too_deep_at(tokens_, {0, tokens_.size() - 2}).has_value(); }

    /// Returns nothing if the token is not accepted, otherwise the rules around it, innermost
    /// first. A word that could also be a name counts as a name unless `following` decides.
    std::optional<std::vector<std::size_t>> rules_of(std::size_t type,
                                                     std::optional<std::size_t> following = {}) {
        first_->setType(type);
        second_->setType(following.value_or(EtlLexer::IDENTIFIER));
        SliceStream stream(tokens_, {0, tokens_.size() - (following ? 1 : 2)});
        EtlParser parser(&stream);
        parser.removeErrorListeners();
        parser.setErrorHandler(std::make_shared<Stop>());
        Watch watch(first_);
        parser.addParseListener(&watch);
        try {
            parser.declaration();
        } catch (const Stopped& stopped) {
            if (stopped.at->getType() != Token::EOF) return std::nullopt;
        }
        return watch.rules();
    }

private:
    antlr4::CommonToken* add(std::size_t type, std::size_t offset) {
        auto token = std::make_unique<antlr4::CommonToken>(type);
        token->setStartIndex(offset);
        token->setStopIndex(offset);
        auto* const added = token.get();
        tokens_.push_back(std::move(token));
        return added;
    }

    Tokens tokens_;
    antlr4::CommonToken* first_;
    antlr4::CommonToken* second_;
};

bool has(const std::vector<std::size_t>& rules, std::size_t rule) {
    return std::find(rules.begin(), rules.end(), rule) != rules.end();
}

/// Returns the role of a name within these rules.
Role role_in(const std::vector<std::size_t>& rules, std::size_t declaration) {
    if (has(rules, EtlParser::RuleAmount))
        return has(rules, EtlParser::RuleBound) || has(rules, EtlParser::RuleDelay) ? Role::bound
                                                                                    : Role::amount;
    if (!rules.empty() && rules[0] == EtlParser::RuleFittedArgument) return Role::fitting_argument;
    if (rules.size() < 2 || rules[0] != EtlParser::RuleName) return Role::none;
    switch (rules[1]) {
        case EtlParser::RulePrimary: return Role::operand;
        case EtlParser::RuleLocated: return Role::point;
        case EtlParser::RuleWeights: return Role::weights;
        case EtlParser::RuleEncodedBy: return Role::encoder;
        case EtlParser::RuleCalibrated: return Role::calibration;
        case EtlParser::RuleFitted: return Role::fitting;
        case EtlParser::RuleArgument:
            return declaration == EtlParser::DRIFT ? Role::drift_argument
                                                   : Role::calibration_argument;
        case EtlParser::RuleDeclaration:
            if (declaration == EtlParser::TRUTH) return Role::predicate;
            if (declaration == EtlParser::DRIFT) return Role::watched;
            return declaration == EtlParser::PERIOD ? Role::amount : Role::none;
        default: return Role::none;
    }
}

/// Returns the spellings of a token: two for operators.
std::vector<std::string> spellings(std::size_t type) {
    if (const auto kind = operator_kind(type)) {
        const ast::Operator& op = *ast::operator_of(*kind);
        if (op.symbol == op.word) return {std::string(op.word)};
        return {std::string(op.symbol), std::string(op.word)};
    }
    if (type == EtlLexer::STEPS) return {"steps", "step"};
    if (type != EtlLexer::DISTANCE) return {keyword(type)};
    std::vector<std::string> words = distance_words();
    std::erase(words, keyword(EtlLexer::MAHALANOBIS));
    return words;
}

/// Whether the text ends in a comment, which is not a token.
bool ends_in_comment(std::string_view text, std::size_t from) {
    for (std::size_t i = from; i + 1 < text.size(); ++i) {
        const std::string_view two = text.substr(i, 2);
        if (two == "//") {
            i = text.find_first_of("\r\n", i);
            if (i == std::string_view::npos) return true;
        } else if (two == "/*") {
            i = text.find("*/", i + 2);
            if (i == std::string_view::npos) return true;
            ++i;
        }
    }
    return false;
}

/// A word that ends at the place may be unfinished.
bool is_typed(const Token& token, std::uint32_t offset, const source::File& before) {
    const bool word = is_name(token) || is_reserved_word(token, before);
    return word && span_of(token).end == offset;
}

bool is_name_in(const std::vector<std::size_t>& rules) {
    return !rules.empty() && rules.front() == EtlParser::RuleName;
}

/// Whether the token is accepted as a word of the language. A contextual word may also be a name,
/// which only the next token decides: one that follows distances, functions and operators.
bool is_word(Probe& probe, std::size_t type) {
    const auto rules = probe.rules_of(type);
    if (!rules) return false;
    if (!is_name_in(*rules)) return true;
    if (type < EtlLexer::RISE || (type > EtlLexer::HELD && type < EtlLexer::DISTANCE)) return false;
    for (const std::size_t next :
         {EtlLexer::LPAREN, EtlLexer::LBRACKET, EtlLexer::DISTANCE, EtlLexer::TRUE}) {
        const auto longer = probe.rules_of(type, next);
        if (longer && !longer->empty() && !is_name_in(*longer)) return true;
    }
    return false;
}

/// Fills in what the grammar accepts.
void ask(Continuations& found, Tokens tokens, std::uint32_t offset) {
    const std::size_t declaration = tokens.empty() ? Token::EOF : tokens.front()->getType();
    const std::size_t previous = tokens.empty() ? Token::EOF : tokens.back()->getType();
    Probe probe(std::move(tokens), offset);
    if (probe.is_too_deep()) return;
    for (std::size_t type = EtlLexer::SPEC; type < EtlLexer::IDENTIFIER; ++type) {
        if (!is_word(probe, type)) continue;
        for (std::string& word : spellings(type)) found.words.push_back(std::move(word));
    }
    if (const auto rules = probe.rules_of(EtlLexer::IDENTIFIER)) {
        found.role = role_in(*rules, declaration);
        if (found.role == Role::watched && previous != EtlLexer::OF)
            found.role = Role::none;  // the drift itself
        // Names between the brackets of [px, py] are scalars, and a distance has its target last.
        const bool is_whole = rules->size() > 3 && (*rules)[3] == EtlParser::RuleDistance;
        const bool in_list = previous == EtlLexer::LBRACKET || previous == EtlLexer::COMMA;
        if (found.role == Role::point && in_list)
            found.role = is_whole ? Role::target : Role::scalar;
    }
    const auto number = probe.rules_of(EtlLexer::NUMBER);
    found.number = number.has_value();
    found.in_interval = number && has(*number, EtlParser::RuleBound);
}

}  // namespace

Continuations continuations_at(const source::File& file, std::uint32_t offset) {
    const source::File before(file.path(), std::string(file.text().substr(0, offset)));
    Continuations found;
    found.typed = {offset, offset};
    found.begin = offset;
    Tokens tokens = tokens_of(before);
    tokens.pop_back();  // EOF
    const std::uint32_t end = tokens.empty() ? 0 : span_of(*tokens.back()).end;
    if (ends_in_comment(before.text(), end)) return found;
    if (!tokens.empty() && is_typed(*tokens.back(), offset, before)) {
        found.typed = span_of(*tokens.back());
        tokens.pop_back();
    }
    const auto ends = [](const auto& token) { return token->getType() == EtlLexer::SEMICOLON; };
    const auto last = std::find_if(tokens.rbegin(), tokens.rend(), ends);
    tokens.erase(tokens.begin(), last.base());
    if (std::any_of(tokens.begin(), tokens.end(), [](const auto& t) { return is_mistake(*t); }))
        return found;
    if (!tokens.empty()) {
        found.begin = span_of(*tokens.front()).begin;
        found.declaration = text_of(*tokens.front(), before);
        if (tokens.back()->getType() == EtlLexer::NUMBER)
            found.number_before = text_of(*tokens.back(), before);
    }
    if (tokens.size() > kMostTokens) return found;
    ask(found, std::move(tokens), offset);
    return found;
}

}  // namespace etlc::parse
