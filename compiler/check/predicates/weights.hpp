// The weights of mahalanobis(M): a symmetric positive definite matrix, the inverse of a covariance.
// Takes: a loaded or literal matrix or diagonal, or a target's name. Gives: float32 weights as
// Distance keeps them. Keeps true: a full matrix is exactly symmetric and has a Cholesky factor; a
// diagonal is positive.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ast/ast.hpp"
#include "check/context/context.hpp"

namespace etlc::check {

/// |W_ij - W_ji| may be this times sqrt(W_ii W_jj): float32 files of a symmetric matrix differ by
/// rounding. The weights are then the mean of the two.
inline constexpr double kSymmetryTolerance = 1e-5;

struct Weights {
    std::vector<float> values;
    bool diagonal = false;
    std::string path;
    std::string text;  ///< canonical: a name, load("w.npy"), or the numbers of a small literal
    std::string hash;
    Index fitted = kNone;  ///< of model.fitted
};

/// The weights for distances from the model's `point`; nothing, with a diagnostic, where they do
/// not fit.
std::optional<Weights> check_weights(Context& context, const ast::Weights& weights, Index point,
                                     Span span);

}  // namespace etlc::check
