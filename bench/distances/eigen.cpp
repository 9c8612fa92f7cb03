// Eigen: the matrix product, |z|^2 + |g|^2 - 2 z.g, and the direct form.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "cells.hpp"

namespace bench {
namespace {

// Small sets have compile-time sizes, as an Eigen user would write them.
constexpr int size(std::uint32_t n, bool fixed) {
    return fixed ? static_cast<int>(n) : Eigen::Dynamic;
}

template <std::uint32_t K, std::uint32_t D>
struct Forms {
    static constexpr bool kFixed = K * D <= 4096 && K > 1;
    using Targets = Eigen::Matrix<float, size(K, kFixed), size(D, kFixed), Eigen::RowMajor>;
    using Point = Eigen::Matrix<float, size(D, kFixed), 1>;
    using Rows = Eigen::Matrix<float, size(K, kFixed), 1>;

    __attribute__((noinline)) static float gemv(const float* z, const float* targets,
                                                const void* lengths) {
        const Eigen::Map<const Targets> g(targets, K, D);
        const Eigen::Map<const Point> x(z, D);
        const Eigen::Map<const Rows> squares(static_cast<const float*>(lengths), K);
        static Rows products(K);
        products.noalias() = g * x;
        return std::sqrt(std::max(0.0F, x.squaredNorm() + (squares - 2 * products).minCoeff()));
    }
    __attribute__((noinline)) static float direct(const float* z, const float* targets,
                                                  const void*) {
        const Eigen::Map<const Targets> g(targets, K, D);
        const Eigen::Map<const Point> x(z, D);
        return std::sqrt((g.rowwise() - x.transpose()).rowwise().squaredNorm().minCoeff());
    }
};

}  // namespace

Contestant eigen_gemv() {
#define CELL(D, K) entry<Forms<K, D>::gemv>({D, K}),
    return {"Eigen GEMV", squared_lengths, {ETLC_BENCH_CELLS(CELL)}};
#undef CELL
}
Contestant eigen_direct() {
#define CELL(D, K) entry<Forms<K, D>::direct>({D, K}),
    return {"Eigen direct", nullptr, {ETLC_BENCH_CELLS(CELL)}};
#undef CELL
}

}  // namespace bench
