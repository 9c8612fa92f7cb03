// Builds nodes of the model's DAG from the tree of a formula. Lets in it have been built, and are
// the nodes that they name. Operands have smaller indices; depth is at most kMaxDepth.
#pragma once

#include "check/context/context.hpp"

namespace etlc::check {

/// Returns the index of the formula's node; kNone after an error, or if it names something broken.
Index check_formula(Context& context, const ast::Formula& formula);

}  // namespace etlc::check
