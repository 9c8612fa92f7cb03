#include "fit/algebra/cholesky.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

#include "fit/algebra/products.hpp"

namespace etlc::fit {

std::optional<Cholesky> Cholesky::of(Matrix symmetric) {
    constexpr double kLeastCondition = 1e-13;
    constexpr Eigen::Index kBlock = 64;
    // By blocks of columns, so that most of it are products.
    const Eigen::Index n = symmetric.rows();
    for (Eigen::Index begin = 0; begin < n; begin += kBlock) {
        const Eigen::Index here = std::min(kBlock, n - begin);
        const Eigen::Index rest = n - begin - here;
        Eigen::Ref<Matrix> corner = symmetric.block(begin, begin, here, here);
        const Eigen::LLT<Eigen::Ref<Matrix>> in_place(corner);
        if (in_place.info() != Eigen::Success) return std::nullopt;
        Eigen::Ref<Matrix> below = symmetric.block(begin + here, begin, rest, here);
        corner.triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(below);
        add_products(below, -1, symmetric.bottomRightCorner(rest, rest));
    }
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
