// Affine maps, in double.
#pragma once

#include <Eigen/Core>

namespace etlc::fit {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// P(z) = A (z - m).
struct Affine {
    Matrix a;       ///< R x D
    Vector offset;  ///< m: D

    /// Of frames that are columns.
    Matrix operator()(const Matrix& frames) const { return a * (frames.colwise() - offset); }
};

}  // namespace etlc::fit
