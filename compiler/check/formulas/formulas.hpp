// Builds nodes of the model's DAG from the tree of a formula. Lets in it have been built, and are
// the nodes that they name. Operands have smaller indices; depth is at most kMaxDepth.
#pragma once

#include "check/context/context.hpp"

namespace etlc::check {

/// Returns the index of the formula's node; kNone after an error, or if it names something broken.
Index check_formula(Context& context, const ast::Formula& formula);

/// Whether the expression is count(f, D).
bool is_count(const ast::Expr& expression);
/// Returns the index of the formula for a comparison with a count on one side: how often a formula
/// began to hold; kNone after an error.
Index check_count(Context& context, const ast::Formula& comparison);

/// Adds a node and returns its index. `depth`: levels of the formula with its lets written out.
Index add_formula(Context& context, Formula formula, Span operator_span, std::uint32_t depth);

/// Returns the formula with truths in place of the lets that have one; kNone where it has none of
/// these lets, or after an error.
Index with_truths_of_lets(Context& context, Index formula);

/// Returns the node of a comparison that has neither a name nor a truth; otherwise kNone.
Index node_without_truth(const Model& model, Index root);

}  // namespace etlc::check
