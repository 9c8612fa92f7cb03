#include "fit/algebra/cholesky.hpp"

#include <Eigen/Cholesky>

#include "fit/algebra/products.hpp"

namespace etlc::fit {

std::optional<Cholesky> Cholesky::of(Matrix symmetric) {
    constexpr double kLeastCondition = 1e-13;
    const Eigen::LLT<Eigen::Ref<Matrix>> in_place(symmetric);
    if (in_place.info() != Eigen::Success) return std::nullopt;
    const auto diagonal = symmetric.diagonal();
    if (!(diagonal.minCoeff() > kLeastCondition * diagonal.maxCoeff())) return std::nullopt;
    return Cholesky(std::move(symmetric));
}

Vector Cholesky::solve(const Vector& right) const {
    const auto lower = lower_.triangularView<Eigen::Lower>();
    return lower.transpose().solve(lower.solve(right));
}

Matrix Cholesky::inverse() const {
    const Eigen::Index n = lower_.rows();
    Matrix of_lower = Matrix::Identity(n, n);
    lower_.triangularView<Eigen::Lower>().solveInPlace(of_lower);
    Matrix result = Matrix::Zero(n, n);
    add_products(of_lower.transpose(), 1, result);
    return result.selfadjointView<Eigen::Lower>();
}

}  // namespace etlc::fit
