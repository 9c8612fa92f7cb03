// Checks M in mahalanobis(M): a symmetric positive definite matrix, the inverse of a covariance.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "check/context/context.hpp"

namespace etlc::check {

struct Weights {
    std::vector<float> values;
    bool diagonal = false;
    std::string path;
    std::string text;  ///< canonical: a name, load("w.npy"), or the numbers of a small literal
    std::string hash;
    Index fitted = kNone;  ///< in model.fitted
};

/// Returns the weights for distances from the model's `point`; nothing after an error.
std::optional<Weights> check_weights(Context& context, const ast::Weights& weights, Index point,
                                     Span span);

}  // namespace etlc::check
