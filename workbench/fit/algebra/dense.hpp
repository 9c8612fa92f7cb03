// Dense linear algebra of fitting, in double: affine maps, products, factors and eigenvectors.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <utility>
#include <vector>

namespace etlc::fit {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// Call this first: the order of sums in Eigen's products depends on cache sizes. With these fixed
/// ones, it is the same on every machine.
inline void fix_order_of_sums() {
    [[maybe_unused]] static const bool once =  // other threads may be at work
        (Eigen::setCpuCacheSizes(32 << 10, 512 << 10, 4 << 20), true);
}

/// P(z) = A (z - m).
struct Affine {
    Matrix a;       ///< R x D
    Vector offset;  ///< m: D

    /// Maps frames, which are columns.
    Matrix operator()(const Matrix& frames) const { return a * (frames.colwise() - offset); }
};

/// Adds factor * columns * columns^T to the lower triangle; above it anything may be written.
/// Fitting spends most of its time here. Every element is summed in the order of the columns, each
/// product rounded before it is added, so machines with wider vectors give the same bits. Eigen
/// takes twice as long, because it is compiled for the oldest machine's vectors. `jobs`: threads;
/// 0: one per core.
void add_products(const Eigen::Ref<const Matrix>& columns, double factor, Eigen::Ref<Matrix> lower,
                  unsigned jobs = 1);

/// Returns the squared distance of a point from a mean. The order of the sum is the same on every
/// machine.
double squared_distance(const std::vector<float>& point, const Vector& mean);

/// The Cholesky factor L of a covariance S = L L^T, of which the lower triangle is read. Eigen
/// takes twice as long, and fitting a discriminant makes fifty factors.
class Cholesky {
public:
    /// Returns nothing where S is not positive definite in double.
    static std::optional<Cholesky> of(Matrix symmetric);

    /// Solves S x = right.
    Vector solve(const Vector& right) const;
    /// Returns S^-1, symmetric.
    Matrix inverse() const;
    /// Returns the memory for reuse.
    Matrix release() && { return std::move(lower_); }

private:
    explicit Cholesky(Matrix lower) : lower_(std::move(lower)) {}

    Matrix lower_;  ///< L, in the lower triangle
};

/// Returns the greatest eigenvalues of a symmetric matrix, of which the lower triangle is read, and
/// their eigenvectors, in descending order. Vectors are orthogonal to rounding, also those of equal
/// eigenvalues. For few of them the others are not computed: tridiagonal form, its eigenvalues,
/// inverse iteration (Golub, Van Loan, "Matrix Computations", 8.3 and 8.4).
struct Eigenpairs {
    Vector values;
    Matrix vectors;  ///< as columns
};
Eigenpairs greatest_eigenpairs(const Matrix& symmetric, Eigen::Index count);

}  // namespace etlc::fit
