// Points of distances, and target sets in their spaces.
// Takes: a point as written, and a target. Gives: the point in the model, and the target with its
// rows where the point is. Keeps true: equal points stand once; a point stands behind the one that
// it is projected from; rows are taken for what the declaration of their target says they are, and
// never for what their dimension would allow.
#pragma once

#include "ast/ast.hpp"
#include "check/context/context.hpp"

namespace etlc::check {

/// The index in model.points; kNone where it had an error, which is reported.
Index check_point(Context& context, const ast::Point& point);

/// The target itself where its rows are in the space of the point, else its rows projected into it;
/// kNone, with a diagnostic, where no projection of the point leads there, or dimensions differ.
Index target_in_space(Context& context, Index target, Index point, Span span);

}  // namespace etlc::check
