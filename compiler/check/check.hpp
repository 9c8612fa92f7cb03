// Syntax tree to typed spec.
// Takes: the tree, and the files it loads (paths relative to the spec). Gives: the model, or
// nothing where there was an error. Keeps true: all errors are reported in one go, each cause once;
// a broken declaration hides no other and causes no cascade.
#pragma once

#include <optional>

#include "ast/ast.hpp"
#include "check/context/options.hpp"
#include "check/model/model.hpp"
#include "diag/diag.hpp"

namespace etlc::check {

/// Nothing where there was an error, or where a target is allowed to be missing and is.
std::optional<Model> check(ast::Spec spec, const source::File& file, const Options& options,
                           diag::Sink& sink);

/// What `etlc embed` needs: of the model the encoders, the inputs, what the targets encode, and the
/// rate. Nothing where there was an error in these.
std::optional<Model> check_encoded(ast::Spec spec, const source::File& file, const Options& options,
                                   diag::Sink& sink);

}  // namespace etlc::check
