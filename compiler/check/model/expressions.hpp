// Expressions of the model, and numbers that earlier steps have a part in.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ast/operators.hpp"
#include "check/model/inputs.hpp"
#include "check/numbers/range.hpp"
#include "source/source.hpp"

namespace etlc::check {

/// EXPR, evaluated in float32 in the given order, where each operation rounds once.
struct Expr {
    using Kind = ast::ExprKind;
    Kind kind = Kind::number;
    std::string text;    ///< decimal text of a number
    double number = 0;   ///< rounded to double, for truth formulas only
    float number32 = 0;  ///< rounded once to float32
    Index index = 0;     ///< of the input, distance or past number
    std::vector<Expr> arguments;
    Span span;
};

/// Visits EXPR and its parts, the whole first.
template <class Visit>
void for_each(const Expr& expression, const Visit& visit) {
    visit(expression);
    for (const Expr& argument : expression.arguments) for_each(argument, visit);
}

/// Visits EXPR and its parts, the whole first, but not the parts of numbers that earlier steps have
/// a part in: what is computed at every step by itself.
template <class Visit>
void for_each_of_step(const Expr& expression, const Visit& visit) {
    visit(expression);
    if (expression.kind == Expr::Kind::past) return;
    for (const Expr& argument : expression.arguments) for_each_of_step(argument, visit);
}

/// Visits the distances in EXPR, by index, as often as each occurs.
template <class Visit>
void for_each_distance(const Expr& expression, const Visit& visit) {
    for_each(expression, [&](const Expr& e) {
        if (e.kind == Expr::Kind::distance) visit(e.index);
    });
}

/// A number that earlier steps have a part in: EXPR@n, mean(EXPR, n), where n counts steps. In a
/// predicate it is an Expr of kind `past`, whose argument is EXPR.
struct Past {
    using Kind = ast::PastKind;
    Kind kind = Kind::ago;
    Expr expression;  ///< EXPR; may contain earlier elements of Model::pasts
    std::uint32_t steps = 1;
    std::string text;  ///< canonical text: "mean(x, 60 steps)"
    Range range;       ///< of the number
    Span span;
};

}  // namespace etlc::check
