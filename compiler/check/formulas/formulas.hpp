// Formulas: the tree of one formula to nodes of the model's DAG.
// Takes: the tree, with every let that it names already built. Gives: the index of its node.
// Keeps true: operands have smaller indices; a let is the node that it names; depth is at most
// kMaxDepth.
#pragma once

#include "check/context/context.hpp"

namespace etlc::check {

/// kNone where the formula had an error, which is reported, or names something broken.
Index check_formula(Context& context, const ast::Formula& formula);

}  // namespace etlc::check
