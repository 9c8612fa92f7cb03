// fitted(METHOD, of = POINT, where = FORMULA, ...): elements that `etlc fit` computes from
// episodes, and their values in its file. An element depends only on projections declared before
// it.
#pragma once

#include <string>

#include "ast/ast.hpp"
#include "check/context/context.hpp"

namespace etlc::check {

/// Returns the index in model.fitted; kNone after an error. It fills the declaration `name`, the
/// model's target or projection `index`. Metrics, mahalanobis(fitted(...)), have neither, and equal
/// ones are shared.
Index check_fitted(Context& context, const ast::Fitted& written, Fitted::Slot slot,
                   std::string name = {}, Index index = kNone);

/// Returns the entry with the shape that the spec asks for, and marks the element as filled; null
/// if there is none, which is an error unless --check allows it. The first call reads the file.
const fitted::Entry* fitted_entry(Context& context, Index fitted);

}  // namespace etlc::check
