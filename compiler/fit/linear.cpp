#include "fit/linear.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

namespace etlc::fit {

namespace {

/// The first of two elements of equal magnitude decides.
Vector with_sign(const Vector& direction) {
    Eigen::Index greatest = 0;
    direction.cwiseAbs().maxCoeff(&greatest);
    return direction(greatest) < 0 ? Vector(-direction) : direction;
}

using Cholesky = Eigen::LLT<Matrix>;

/// Nothing where the matrix is not positive definite in double.
std::optional<Cholesky> factorised(const Matrix& symmetric) {
    constexpr double kLeastCondition = 1e-13;
    Cholesky result(symmetric);
    if (result.info() != Eigen::Success) return std::nullopt;
    const Vector diagonal = result.matrixLLT().diagonal();
    if (!(diagonal.minCoeff() > kLeastCondition * diagonal.maxCoeff())) return std::nullopt;
    return result;
}

bool has_both(const Moments& moments) {
    return moments.frames(0) > 0 && moments.frames(kHolds) > 0;
}

/// How many standard deviations within classes the class means of `moments` are apart along it.
double separation(const Moments& moments, const Matrix& scatter, const Vector& direction) {
    const double apart = direction.dot(moments.mean(kHolds) - moments.mean(0));
    const double variance =
        direction.dot(scatter * direction) / static_cast<double>(moments.frames());
    return apart / std::sqrt(variance + std::numeric_limits<double>::min());
}

}  // namespace

Matrix covariance(const Moments& moments) {
    return moments.scatter() / (static_cast<double>(moments.frames(kHolds)) - 1);
}

Components principal_components(const Moments& moments, Eigen::Index r, bool whitened) {
    constexpr double kNoVariance = 1e-12;  // relative: what rounding leaves of float32 data
    const Eigen::SelfAdjointEigenSolver<Matrix> solver(covariance(moments));
    const Vector& variances = solver.eigenvalues();  // ascending
    const Eigen::Index d = variances.size();
    Components result;
    result.rank = (variances.array() > kNoVariance * variances(d - 1)).count();
    result.map = {Matrix(r, d), moments.mean(kHolds)};
    for (Eigen::Index i = 0; i < r; ++i) {
        const double length = whitened ? std::sqrt(variances(d - 1 - i)) : 1;
        result.map.a.row(i) = with_sign(solver.eigenvectors().col(d - 1 - i)).transpose() / length;
    }
    result.explained = variances.tail(r).sum() / variances.sum();
    return result;
}

Matrix shrunk_covariance(const Moments& moments, double shrinkage) {
    Matrix result = moments.scatter() / static_cast<double>(moments.frames());
    const double mean = result.trace() / static_cast<double>(result.rows());
    result *= 1 - shrinkage;
    result.diagonal().array() += shrinkage * mean;
    return result;
}

std::optional<Matrix> metric(const Moments& moments, double shrinkage) {
    const auto cholesky = factorised(shrunk_covariance(moments, shrinkage));
    if (!cholesky) return std::nullopt;
    const Eigen::Index d = moments.dimension();
    const Matrix inverse = cholesky->solve(Matrix::Identity(d, d));
    return (inverse + inverse.transpose()) / 2;
}

std::optional<Affine> discriminant(const Moments& moments, double shrinkage) {
    if (!has_both(moments)) return std::nullopt;
    const auto cholesky = factorised(shrunk_covariance(moments, shrinkage));
    const Vector apart = moments.mean(kHolds) - moments.mean(0);
    if (!cholesky || apart.isZero(0)) return std::nullopt;
    const Vector direction = cholesky->solve(apart);
    return Affine{direction.transpose() / std::sqrt(direction.dot(apart)),
                  (moments.mean(0) + moments.mean(kHolds)) / 2};
}

std::optional<double> best_shrinkage(const std::vector<const Moments*>& folds) {
    constexpr std::size_t kCandidates = std::size(kShrinkages);
    std::array<double, kCandidates> sums{};
    std::array<std::size_t, kCandidates> counts{};
    for (const Moments* test : folds) {
        if (!has_both(*test)) continue;
        Moments training(test->dimension(), true);
        for (const Moments* fold : folds)
            if (fold != test) training.merge(*fold);
        const Matrix scatter = test->scatter();
        for (std::size_t i = 0; i < kCandidates; ++i) {
            const auto direction = discriminant(training, kShrinkages[i]);
            if (!direction) continue;
            sums[i] += separation(*test, scatter, direction->a.transpose());
            ++counts[i];
        }
    }
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < kCandidates; ++i)
        if (counts[i] >= 2 && (!best || counts[i] > counts[*best] ||
                               (counts[i] == counts[*best] && sums[i] > sums[*best])))
            best = i;
    if (!best) return std::nullopt;
    return kShrinkages[*best];
}

Affine logpzo(const Moments& moments) {
    const Matrix s = covariance(moments);
    const Matrix identity = Matrix::Identity(s.rows(), s.cols());
    // Both factors are polynomials in S, so their order does not count.
    const Matrix a = Cholesky(identity + s).solve(2.5 * identity - 0.5 * s);
    return {a, moments.mean(kHolds)};
}

}  // namespace etlc::fit
