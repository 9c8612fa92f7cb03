// fitted(METHOD, of = POINT, where = FORMULA, ...): what `etlc fit` computes from episodes.
// Takes: the words. Gives: a row of model.fitted, with its shape. Keeps true: a row depends on
// projections that stand before it alone.
#pragma once

#include <string>

#include "ast/ast.hpp"
#include "check/context/context.hpp"

namespace etlc::check {

/// The index in model.fitted of what fills the declaration `name`, the model's target or projection
/// `index`; kNone where it had an error, which is reported.
Index check_fitted(Context& context, const ast::Fitted& written, Fitted::Slot slot,
                   const std::string& name, Index index);

/// The same of a metric, mahalanobis(fitted(...)): equal ones stand once.
Index check_fitted_metric(Context& context, const ast::Fitted& written);

}  // namespace etlc::check
