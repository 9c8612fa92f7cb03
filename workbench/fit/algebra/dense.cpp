#include "fit/algebra/dense.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <iterator>
#include <limits>
#include <numeric>

#include "episodes/bootstrap.hpp"
#include "episodes/parallel.hpp"

namespace etlc::fit {

namespace {

using Eigen::Index;

/// Rows of a panel, which are packed side by side for each column.
constexpr Index kPanel = 8;

struct alignas(64) PanelColumn {
    double rows[kPanel];
};

Index panels_of(Index rows) {
    return (rows + kPanel - 1) / kPanel;
}

/// Packs panel by panel, in each column by column; pads the last panel with 0.
std::vector<PanelColumn> packed(const Eigen::Ref<const Matrix>& columns) {
    const Index depth = columns.cols();
    const Index panels = panels_of(columns.rows());
    std::vector<PanelColumn> result(static_cast<std::size_t>(panels * depth));
    for (Index panel = 0; panel < panels; ++panel) {
        const Index n = std::min(kPanel, columns.rows() - panel * kPanel);
        for (Index k = 0; k < depth; ++k)
            std::copy_n(columns.col(k).data() + panel * kPanel, n,
                        result[static_cast<std::size_t>(panel * depth + k)].rows);
    }
    return result;
}

// Inlined code is compiled for the target of the function around it.
#define ETLC_INLINE [[gnu::always_inline]] inline

/// A tile of the result, kPanel rows by `kColumns`, summed in registers of `Lanes`.
template <class Lanes, Index kColumns>
struct Tile {
    static constexpr Index kLanes = sizeof(Lanes) / sizeof(double);
    static constexpr Index kRegisters = kPanel / kLanes;

    Lanes sums[kColumns][kRegisters];

    ETLC_INLINE void sum(const PanelColumn* left, const PanelColumn* right, Index first,
                         Index depth) {
        for (Index j = 0; j < kColumns; ++j)
            for (Index r = 0; r < kRegisters; ++r) sums[j][r] = Lanes{};
        for (Index k = 0; k < depth; ++k) {
            Lanes rows[kRegisters];
            for (Index r = 0; r < kRegisters; ++r)
                rows[r] = *reinterpret_cast<const Lanes*>(left[k].rows + r * kLanes);
            for (Index j = 0; j < kColumns; ++j)
                for (Index r = 0; r < kRegisters; ++r)
                    sums[j][r] += rows[r] * right[k].rows[first + j];
        }
    }

    ETLC_INLINE void add_to(Eigen::Ref<Matrix>& lower, Index row, Index column,
                            double factor) const {
        const Index rows = std::min(kPanel, lower.rows() - row);
        for (Index j = 0; j < std::min(kColumns, lower.cols() - column); ++j) {
            double* to = &lower(row, column + j);
            for (Index i = 0; i < rows; ++i) to[i] += factor * sums[j][i / kLanes][i % kLanes];
        }
    }
};

/// Adds the products with the rows of panel `right`, which are columns of the result.
template <class Lanes, Index kColumns>
ETLC_INLINE void add_tiles(const PanelColumn* panels, Index right, Index depth, double factor,
                           Eigen::Ref<Matrix>& lower) {
    const Index all = panels_of(lower.rows());
    for (Index left = right; left < all; ++left)
        for (Index first = 0; first < kPanel; first += kColumns) {
            Tile<Lanes, kColumns> tile;
            tile.sum(panels + left * depth, panels + right * depth, first, depth);
            tile.add_to(lower, left * kPanel, right * kPanel + first, factor);
        }
}

using AddTiles = void(const PanelColumn* panels, Index right, Index depth, double factor,
                      Eigen::Ref<Matrix>& lower);

using Lanes16 [[gnu::vector_size(16), gnu::may_alias]] = double;

void add_with_16_bytes(const PanelColumn* panels, Index right, Index depth, double factor,
                       Eigen::Ref<Matrix>& lower) {
    add_tiles<Lanes16, 2>(panels, right, depth, factor, lower);
}

#if defined(__x86_64__)
using Lanes32 [[gnu::vector_size(32), gnu::may_alias]] = double;
using Lanes64 [[gnu::vector_size(64), gnu::may_alias]] = double;

[[gnu::target("avx2")]] void add_with_32_bytes(const PanelColumn* panels, Index right, Index depth,
                                               double factor, Eigen::Ref<Matrix>& lower) {
    add_tiles<Lanes32, 4>(panels, right, depth, factor, lower);
}

[[gnu::target("avx512f")]] void add_with_64_bytes(const PanelColumn* panels, Index right,
                                                  Index depth, double factor,
                                                  Eigen::Ref<Matrix>& lower) {
    add_tiles<Lanes64, 8>(panels, right, depth, factor, lower);
}

AddTiles* widest() {
    if (__builtin_cpu_supports("avx512f") != 0) return add_with_64_bytes;
    return __builtin_cpu_supports("avx2") != 0 ? add_with_32_bytes : add_with_16_bytes;
}
#else
constexpr AddTiles* widest() {
    return add_with_16_bytes;
}
#endif

#undef ETLC_INLINE

}  // namespace

void add_products(const Eigen::Ref<const Matrix>& columns, double factor, Eigen::Ref<Matrix> lower,
                  unsigned jobs) {
    if (columns.cols() == 0) return;
    const std::vector<PanelColumn> panels = packed(columns);
    static const auto add = widest();
    const Index all = panels_of(lower.rows());
    std::atomic<Index> next = 0;  // the first panels have the most products
    const auto work = [&] {
        for (Index right = next++; right < all; right = next++)
            add(panels.data(), right, columns.cols(), factor, lower);
    };
    if (jobs == 1) return work();
    if (const auto failure = episodes::in_threads(jobs, static_cast<std::size_t>(all), work))
        std::rethrow_exception(failure);
}

double squared_distance(const std::vector<float>& point, const Vector& mean) {
    constexpr std::size_t kSums = 8;  // independent, so that compilers vectorise them
    double sums[kSums] = {};
    const auto add = [&](std::size_t sum, std::size_t i) {
        const double apart = static_cast<double>(point[i]) - mean(static_cast<Index>(i));
        sums[sum] += apart * apart;
    };
    std::size_t i = 0;
    for (; i + kSums <= point.size(); i += kSums)
        for (std::size_t s = 0; s < kSums; ++s) add(s, i + s);
    for (std::size_t s = 0; i < point.size(); ++i, ++s) add(s, i);
    return std::accumulate(std::begin(sums), std::end(sums), 0.0);
}

std::optional<Cholesky> Cholesky::of(Matrix symmetric) {
    constexpr double kLeastCondition = 1e-13;
    constexpr Eigen::Index kBlock = 64;
    // Works on blocks of columns, so that most of the work is products.
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

namespace {

using Eigen::Index;

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

/// A symmetric tridiagonal matrix; `beside` is above and below the diagonal.
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

/// Solves (T - shift) x = right by Gaussian elimination with row exchanges; a pivot of 0 counts as
/// `least`.
Vector solved(const Tridiagonal& t, double shift, double least, Vector right) {
    const Index n = t.size();
    Vector pivot = t.diagonal.array() - shift;
    Vector above = Vector::Zero(n);   // first beside the diagonal
    Vector above2 = Vector::Zero(n);  // second superdiagonal, after row exchanges
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

/// Computes the eigenvectors of eigenvalues in descending order. Returns nothing where a residual
/// is too large.
std::optional<Matrix> inverse_iteration(const Tridiagonal& t, const Vector& values) {
    constexpr std::uint64_t kSeed = 2026;
    constexpr int kRounds = 4;
    const double norm = t.norm();
    episodes::Random random(kSeed);
    Matrix vectors(t.size(), values.size());
    for (Index i = 0; i < values.size(); ++i) {
        Vector x(t.size());
        for (double& element : x) element = random.unit() - 0.5;
        const double shift =
            values(i) - static_cast<double>(i) * kEpsilon * norm;  // separates equal values
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
