// Predicates: those that are declared, and comparisons that stand in formulas.
// Takes: EXPR CMP THRESHOLD. Gives: a predicate of the model, its robustness range set later, when
// thresholds are known. Keeps true: named predicates stand first, in file order; of equal
// comparisons in formulas there is one predicate.
#pragma once

#include <optional>
#include <vector>

#include "check/context/context.hpp"

namespace etlc::check {

/// The index of the predicate for a comparison in a formula; kNone where it had an error, which is
/// reported.
Index comparison_predicate(Context& context, const ast::Formula& comparison);

/// The typed expression; nothing where it had an error, which is reported.
std::optional<Expr> check_expression(Context& context, const ast::Expr& expression);
/// The distance's index in the model; kNone where it had an error, which is reported.
Index check_distance(Context& context, const ast::Distance& distance);

/// What the expression can be, by interval arithmetic. `undefined` is set to the part, if there is
/// one, that has no value whatever the inputs are: the square root of numbers below zero, a
/// division by zero.
Range range_of(const Model& model, const Expr& expression, const Expr*& undefined);

/// Inputs that the expression reads, ascending.
std::vector<Index> inputs_of(const Model& model, const Expr& expression);

}  // namespace etlc::check
