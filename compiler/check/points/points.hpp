// Points of distances, and target sets in their spaces. Equal points are shared, and a point
// follows the one that it is projected from. The declaration of a target determines the space of
// its rows, never their dimension.
#pragma once

#include <cstdint>
#include <optional>

#include "ast/ast.hpp"
#include "check/context/context.hpp"

namespace etlc::check {

/// Returns the index in model.points; kNone after an error.
Index check_point(Context& context, const ast::Point& point);

/// Returns the steps of `@TIME`, at least 1; nothing after an error.
std::optional<std::uint32_t> steps_ago(Context& context, const ast::Bound& time);

/// Returns the point with all its delays shortened alike until the shortest is zero: the space that
/// it is in.
Index without_delay(Context& context, Index point);

/// Whether two points have equal dimensions and went through equal projections.
bool is_same_space(const Model& model, Index a, Index b);

/// Returns the target if its rows are in the space of the point, otherwise a target with the
/// projected rows; kNone, with an error, if no projection of the point leads there or the
/// dimensions differ.
Index target_in_space(Context& context, Index target, Index point, Span span);

}  // namespace etlc::check
