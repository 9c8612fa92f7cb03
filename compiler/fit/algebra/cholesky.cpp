#include "fit/algebra/cholesky.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

#include "fit/algebra/products.hpp"

namespace etlc::fit {

namespace {

using Eigen::Index;
using Eigen::Lower;

/// Columns that are factorised at a time.
constexpr Index kBlock = 48;

/// Column by column of blocks, from the left; what is right of them is brought up to date at once.
bool factorise(Matrix& lower) {
    const Index n = lower.rows();
    for (Index begin = 0; begin < n; begin += kBlock) {
        const Index block = std::min(kBlock, n - begin);
        const Index rest = n - begin - block;
        Eigen::Ref<Matrix> corner = lower.block(begin, begin, block, block);
        const Eigen::LLT<Matrix> of_corner(corner);
        if (of_corner.info() != Eigen::Success) return false;
        corner.triangularView<Lower>() = of_corner.matrixL();
        Eigen::Ref<Matrix> below = lower.block(begin + block, begin, rest, block);
        corner.triangularView<Lower>().transpose().solveInPlace<Eigen::OnTheRight>(below);
        add_products(below, -1, lower.bottomRightCorner(rest, rest));
    }
    return true;
}

}  // namespace

std::optional<Cholesky> Cholesky::of(Matrix symmetric) {
    constexpr double kLeastCondition = 1e-13;
    if (!factorise(symmetric)) return std::nullopt;
    const auto diagonal = symmetric.diagonal();
    if (!(diagonal.minCoeff() > kLeastCondition * diagonal.maxCoeff())) return std::nullopt;
    return Cholesky(std::move(symmetric));
}

Vector Cholesky::solve(const Vector& right) const {
    const auto lower = lower_.triangularView<Lower>();
    return lower.transpose().solve(lower.solve(right));
}

Matrix Cholesky::inverse() const {
    const Index n = lower_.rows();
    Matrix of_lower = Matrix::Identity(n, n);
    lower_.triangularView<Lower>().solveInPlace(of_lower);
    Matrix result = Matrix::Zero(n, n);
    add_products(of_lower.transpose(), 1, result);
    return result.selfadjointView<Lower>();
}

}  // namespace etlc::fit
