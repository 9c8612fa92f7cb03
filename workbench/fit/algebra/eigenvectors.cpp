#include "fit/algebra/eigenvectors.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <optional>

#include "episodes/random.hpp"

namespace etlc::fit {

namespace {

using Eigen::Index;

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

/// Symmetric: `beside` is above and below the diagonal.
struct Tridiagonal {
    Vector diagonal;
    Vector beside;

    Index size() const { return diagonal.size(); }
    double norm() const {
        return diagonal.cwiseAbs().maxCoeff() + 2 * beside.cwiseAbs().maxCoeff();
    }
    Vector times(const Vector& x) const {
        Vector result = diagonal.cwiseProduct(x);
        result.head(size() - 1) += beside.cwiseProduct(x.tail(size() - 1));
        result.tail(size() - 1) += beside.cwiseProduct(x.head(size() - 1));
        return result;
    }
};

/// Solves (T - shift) x = right by Gauss's elimination with row exchanges; a pivot that is 0 counts
/// as `least`.
Vector solved(const Tridiagonal& t, double shift, double least, Vector right) {
    const Index n = t.size();
    Vector pivot = t.diagonal.array() - shift;
    Vector above = Vector::Zero(n);   // first beside the diagonal
    Vector above2 = Vector::Zero(n);  // second, where rows were exchanged
    above.head(n - 1) = t.beside;
    const auto safe = [&](double x) { return std::abs(x) < least ? least : x; };
    for (Index i = 0; i + 1 < n; ++i) {
        const double below = t.beside(i);
        if (std::abs(below) > std::abs(pivot(i))) {
            const double factor = pivot(i) / below;
            const double next = pivot(i + 1);
            pivot(i + 1) = above(i) - factor * next;
            pivot(i) = below;
            above(i) = next;
            above2(i) = above(i + 1);
            above(i + 1) *= -factor;
            std::swap(right(i), right(i + 1));
            right(i + 1) -= factor * right(i);
        } else {
            const double factor = below / safe(pivot(i));
            pivot(i + 1) -= factor * above(i);
            right(i + 1) -= factor * right(i);
        }
    }
    for (Index i = n; i-- > 0;) {
        if (i + 1 < n) right(i) -= above(i) * right(i + 1);
        if (i + 2 < n) right(i) -= above2(i) * right(i + 2);
        right(i) /= safe(pivot(i));
    }
    return right;
}

/// Of eigenvalues from the greatest. Nothing where the vectors are not what they should be.
std::optional<Matrix> inverse_iteration(const Tridiagonal& t, const Vector& values) {
    constexpr std::uint64_t kSeed = 2026;
    constexpr int kRounds = 4;
    const double norm = t.norm();
    episodes::Random random(kSeed);
    Matrix vectors(t.size(), values.size());
    for (Index i = 0; i < values.size(); ++i) {
        Vector x(t.size());
        for (double& element : x) element = random.unit() - 0.5;
        const double shift = values(i) - static_cast<double>(i) * kEpsilon * norm;  // no two equal
        for (int round = 0; round < kRounds; ++round) {
            x = solved(t, shift, kEpsilon * norm, x.normalized());
            const auto before = vectors.leftCols(i);
            for (int twice = 0; twice < 2; ++twice) x -= before * (before.transpose() * x);
        }
        vectors.col(i) = x.normalized();
        const double residual = (t.times(vectors.col(i)) - values(i) * vectors.col(i)).norm();
        if (!(residual <= 1e-12 * norm)) return std::nullopt;
    }
    return vectors;
}

}  // namespace

Eigenpairs greatest_eigenpairs(const Matrix& symmetric, Index count) {
    const Index n = symmetric.rows();
    if (n > 4 * count && !symmetric.diagonal().isZero(0)) {
        const Eigen::Tridiagonalization<Matrix> found(symmetric);
        const Tridiagonal t{found.diagonal(), found.subDiagonal()};
        Eigen::SelfAdjointEigenSolver<Matrix> solver;
        solver.computeFromTridiagonal(t.diagonal, t.beside, Eigen::EigenvaluesOnly);
        const Vector values = solver.eigenvalues().reverse().head(count);
        if (solver.info() == Eigen::Success)
            if (const auto vectors = inverse_iteration(t, values))
                return {values, found.matrixQ() * *vectors};
    }
    const Eigen::SelfAdjointEigenSolver<Matrix> solver(symmetric);
    return {solver.eigenvalues().reverse().head(count),
            solver.eigenvectors().rowwise().reverse().leftCols(count)};
}

}  // namespace etlc::fit
