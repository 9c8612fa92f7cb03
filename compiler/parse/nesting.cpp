// Measures how deep a declaration nests, in one pass: everything that the grammar reads by
// recursion counts.
#include <vector>

#include "EtlLexer.h"
#include "parse/parse.hpp"
#include "parse/stream/slices.hpp"

namespace etlc::parse {

using grammar::EtlLexer;

namespace {

/// Operators that are open between one pair of brackets.
struct Level {
    int base = 0;      ///< depth outside the bracket, plus one
    int arrows = 0;    ///< `->` in a row
    int untils = 0;    ///< U W R S in a row
    int prefixes = 0;  ///< ! X F G Y O H rise fall held in a row
    int signs = 0;     ///< `-` before an operand, in a row

    int depth() const { return base + arrows + untils + prefixes + signs; }
};

/// `rise`, `fall` and `held` are names elsewhere.
bool is_prefix_word(const Token& token, const Token& next) {
    if (token.getType() == EtlLexer::HELD) return next.getType() == EtlLexer::LBRACKET;
    const bool edge = token.getType() == EtlLexer::RISE || token.getType() == EtlLexer::FALL;
    return edge && begins_operand(next);
}

void operator_seen(Level& level, const Token& token, bool after_operand) {
    if (const auto kind = operator_kind(token.getType()); kind && !is_name(token)) {
        switch (ast::operator_of(*kind)->level) {
            case ast::kPrefix: ++level.prefixes; return;
            case ast::kBinary: level = {level.base, level.arrows, level.untils + 1}; return;
            case ast::kAnd:
            case ast::kOr: level = {level.base, level.arrows}; return;
            case ast::kImplies: level = {level.base, level.arrows + 1}; return;
            default: level = {level.base}; return;
        }
    }
    if (token.getType() == EtlLexer::MINUS && !after_operand)
        ++level.signs;
    else if (is(&token, {EtlLexer::MINUS, EtlLexer::PLUS, EtlLexer::TIMES, EtlLexer::DIVIDE,
                         EtlLexer::LESS_EQUAL, EtlLexer::LESS, EtlLexer::GREATER_EQUAL,
                         EtlLexer::GREATER, EtlLexer::EQUAL, EtlLexer::NOT_EQUAL}))
        level.signs = 0;
    else if (token.getType() == EtlLexer::COMMA)
        level = {level.base};
}

}  // namespace

std::optional<std::size_t> too_deep_at(const Tokens& tokens, Slice slice) {
    std::vector<Level> levels(1);
    bool after_operand = false;
    for (std::size_t i = slice.begin; i < slice.end; ++i) {
        const std::size_t type = tokens[i]->getType();
        if (type == EtlLexer::LPAREN || type == EtlLexer::LBRACKET) {
            levels.push_back({levels.back().depth() + 1});
        } else if (type == EtlLexer::RPAREN || type == EtlLexer::RBRACKET) {
            if (levels.size() > 1) levels.pop_back();
        } else if (i + 1 < slice.end && is_prefix_word(*tokens[i], *tokens[i + 1])) {
            ++levels.back().prefixes;
        } else {
            operator_seen(levels.back(), *tokens[i], after_operand);
        }
        if (levels.back().depth() > kMaxNesting) return i;
        after_operand = ends_operand(tokens[i].get());
    }
    return std::nullopt;
}

}  // namespace etlc::parse
