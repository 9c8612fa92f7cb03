#include "parse/nesting.hpp"

#include <vector>

#include "EtlLexer.h"
#include "parse/parse.hpp"

namespace etlc::parse {

using grammar::EtlLexer;

namespace {

/// What is open between one pair of brackets: everything that the grammar reads by recursion.
struct Level {
    int base = 0;      ///< depth outside the bracket, and one for the bracket
    int arrows = 0;    ///< `->` in a row
    int untils = 0;    ///< U W R S in a row
    int prefixes = 0;  ///< ! X F G Y O H rise fall held in a row
    int signs = 0;     ///< `-` before an operand, in a row

    int depth() const { return base + arrows + untils + prefixes + signs; }
};

bool ends_operand(const Token& token) {
    switch (token.getType()) {
        case EtlLexer::NUMBER:
        case EtlLexer::TRUE:
        case EtlLexer::FALSE:
        case EtlLexer::RPAREN:
        case EtlLexer::RBRACKET: return true;
        default: return is_name(token);
    }
}

bool may_begin_operand(const Token& token) {
    switch (token.getType()) {
        case EtlLexer::NUMBER:
        case EtlLexer::TRUE:
        case EtlLexer::FALSE:
        case EtlLexer::LPAREN:
        case EtlLexer::NOT:
        case EtlLexer::NEXT:
        case EtlLexer::EVENTUALLY:
        case EtlLexer::ALWAYS:
        case EtlLexer::PREVIOUS:
        case EtlLexer::ONCE:
        case EtlLexer::HISTORICALLY: return true;
        default: return is_name(token);
    }
}

/// `rise`, `fall` and `held` are names elsewhere.
bool is_prefix_word(const Token& token, const Token& next) {
    if (token.getType() == EtlLexer::HELD) return next.getType() == EtlLexer::LBRACKET;
    const bool edge = token.getType() == EtlLexer::RISE || token.getType() == EtlLexer::FALL;
    return edge && may_begin_operand(next);
}

void operator_seen(Level& level, std::size_t type, bool after_operand) {
    const Level before = level;
    switch (type) {
        case EtlLexer::MINUS: level.signs = after_operand ? 0 : before.signs + 1; break;
        case EtlLexer::PLUS:
        case EtlLexer::TIMES:
        case EtlLexer::DIVIDE:
        case EtlLexer::LESS_EQUAL:
        case EtlLexer::LESS:
        case EtlLexer::GREATER_EQUAL:
        case EtlLexer::GREATER:
        case EtlLexer::EQUAL:
        case EtlLexer::NOT_EQUAL: level.signs = 0; break;
        case EtlLexer::NOT:
        case EtlLexer::NEXT:
        case EtlLexer::EVENTUALLY:
        case EtlLexer::ALWAYS:
        case EtlLexer::PREVIOUS:
        case EtlLexer::ONCE:
        case EtlLexer::HISTORICALLY: ++level.prefixes; break;
        case EtlLexer::UNTIL:
        case EtlLexer::WEAK_UNTIL:
        case EtlLexer::RELEASE:
        case EtlLexer::SINCE: level = {before.base, before.arrows, before.untils + 1, 0, 0}; break;
        case EtlLexer::AND:
        case EtlLexer::OR: level = {before.base, before.arrows, 0, 0, 0}; break;
        case EtlLexer::IMPLIES: level = {before.base, before.arrows + 1, 0, 0, 0}; break;
        case EtlLexer::IFF:
        case EtlLexer::COMMA: level = {before.base, 0, 0, 0, 0}; break;
        default: break;
    }
}

}  // namespace

std::optional<std::size_t> too_deep_at(const Tokens& tokens, Slice slice) {
    std::vector<Level> levels(1);
    bool after_operand = false;
    for (std::size_t i = slice.begin; i < slice.end; ++i) {
        const std::size_t type = tokens[i]->getType();
        if (type == EtlLexer::LPAREN || type == EtlLexer::LBRACKET) {
            levels.push_back({levels.back().depth() + 1, 0, 0, 0, 0});
        } else if (type == EtlLexer::RPAREN || type == EtlLexer::RBRACKET) {
            if (levels.size() > 1) levels.pop_back();
        } else if (i + 1 < slice.end && is_prefix_word(*tokens[i], *tokens[i + 1])) {
            ++levels.back().prefixes;
        } else {
            operator_seen(levels.back(), type, after_operand);
        }
        if (levels.back().depth() > kMaxNesting) return i;
        after_operand = ends_operand(*tokens[i]);
    }
    return std::nullopt;
}

}  // namespace etlc::parse
