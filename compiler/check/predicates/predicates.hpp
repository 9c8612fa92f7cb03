// Predicates that are declared, and comparisons in formulas. Declared ones come first, in file
// order; equal comparisons share one. Their robustness range is set when thresholds are known.
#pragma once

#include <optional>
#include <vector>

#include "check/context/context.hpp"

namespace etlc::check {

/// Returns the index of the predicate for a comparison in a formula; kNone after an error.
Index comparison_predicate(Context& context, const ast::Formula& comparison);

/// Returns the comparison with its sides exchanged.
Comparison mirrored(Comparison comparison);

/// Returns the typed expression; nothing after an error.
std::optional<Expr> check_expression(Context& context, const ast::Expr& expression);
/// Returns a number that earlier steps have a part in, as an expression; nothing after an error.
std::optional<Expr> check_past(Context& context, const ast::Expr& past);
/// Returns the index of the distance in the model; kNone after an error.
Index check_distance(Context& context, const ast::Distance& distance);

/// Returns the range of the expression by interval arithmetic. `undefined` is set to a part that
/// never has a value: the square root of negative numbers, a division by zero.
Range range_of(const Model& model, const Expr& expression, const Expr*& undefined);

/// Returns the inputs that the expression reads, ascending.
std::vector<Index> inputs_of(const Model& model, const Expr& expression);

}  // namespace etlc::check
