// L L^T = S, for a covariance S.
// Takes: a symmetric matrix, of which the lower triangle counts. Gives: L, and what follows from
// it. Keeps true: the same bits on every machine. Eigen's own takes twice as long, for it knows the
// vectors of the oldest machine alone; fitting a discriminant makes fifty of these.
#pragma once

#include <optional>
#include <utility>

#include "fit/algebra/affine.hpp"

namespace etlc::fit {

class Cholesky {
public:
    /// Nothing where it is not positive definite in double.
    static std::optional<Cholesky> of(Matrix symmetric);

    /// x with S x = right.
    Vector solve(const Vector& right) const;
    /// S^-1, symmetric.
    Matrix inverse() const;
    /// The memory, for another one.
    Matrix release() && { return std::move(lower_); }

private:
    explicit Cholesky(Matrix lower) : lower_(std::move(lower)) {}

    Matrix lower_;  ///< its lower triangle
};

}  // namespace etlc::fit
