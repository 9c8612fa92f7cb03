// fitted(METHOD, of = POINT, where = FORMULA, ...): what `etlc fit` computes from episodes.
// Takes: the words. Gives: a row of model.fitted, with its shape. Keeps true: a row depends on
// projections that stand before it alone.
#pragma once

#include <string>

#include "ast/ast.hpp"
#include "check/context/context.hpp"

namespace etlc::check {

/// The index in model.fitted of what fills the declaration `name`, the model's target or projection
/// `index`; kNone where it had an error, which is reported. Metrics, mahalanobis(fitted(...)), have
/// neither name nor index: equal ones stand once.
Index check_fitted(Context& context, const ast::Fitted& written, Fitted::Slot slot,
                   std::string name = {}, Index index = kNone);

/// The entry with the shape that the spec asks for, which is then filled; null where there is none,
/// which is reported unless it may be missing. The file is read at the first call.
const fitted::Entry* fitted_entry(Context& context, Index fitted);

}  // namespace etlc::check
