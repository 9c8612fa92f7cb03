// Predicates: those that are declared, and comparisons that stand in formulas.
// Takes: EXPR CMP THRESHOLD. Gives: a predicate of the model, its robustness range set later, when
// thresholds are known. Keeps true: named predicates stand first, in file order; of equal
// comparisons in formulas there is one predicate.
#pragma once

#include "check/context/context.hpp"

namespace etlc::check {

/// The index of the predicate for a comparison in a formula; kNone where it had an error, which is
/// reported.
Index comparison_predicate(Context& context, const ast::Formula& comparison);

std::string_view symbol(Comparison comparison);  ///< "<="

}  // namespace etlc::check
