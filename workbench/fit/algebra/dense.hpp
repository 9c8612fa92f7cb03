// What fitting computes with, in double: affine maps, products, factors and eigenvectors.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <utility>

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

/// lower += factor * columns * columns^T, lower triangle alone; above it anything may be written.
/// Fitting spends its time here. Every element is summed in the order of the columns, each product
/// rounded before it is added, so machines with wider vectors give the same bits. Eigen takes twice
/// as long, for it is compiled for the vectors of the oldest machine.
void add_products(const Eigen::Ref<const Matrix>& columns, double factor, Eigen::Ref<Matrix> lower);

/// L L^T = S, for a covariance S, of which the lower triangle counts. Eigen takes twice as
/// long, and fitting a discriminant makes fifty of these.
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

/// The greatest eigenvalues of a symmetric matrix, of which the lower triangle counts, and their
/// eigenvectors, greatest first. Vectors are orthogonal to rounding, those of equal eigenvalues
/// too. Where few are asked for, the others are not computed: tridiagonal form, its eigenvalues,
/// inverse iteration (Golub, Van Loan, "Matrix Computations", 8.3 and 8.4).
struct Eigenpairs {
    Vector values;
    Matrix vectors;  ///< as columns
};
Eigenpairs greatest_eigenpairs(const Matrix& symmetric, Eigen::Index count);

}  // namespace etlc::fit
