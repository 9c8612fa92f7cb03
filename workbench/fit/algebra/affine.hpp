// Affine maps, in double.
#pragma once

#include <Eigen/Core>

namespace etlc::fit {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// Before anything else: the sums of Eigen's products are in an order that depends on the sizes of
/// caches. With these, which need not be those of the machine, it is the same everywhere.
inline void fix_order_of_sums() {
    Eigen::setCpuCacheSizes(32 << 10, 512 << 10, 4 << 20);
}

/// P(z) = A (z - m).
struct Affine {
    Matrix a;       ///< R x D
    Vector offset;  ///< m: D

    /// Of frames that are columns.
    Matrix operator()(const Matrix& frames) const { return a * (frames.colwise() - offset); }
};

}  // namespace etlc::fit
