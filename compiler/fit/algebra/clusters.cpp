#include "fit/algebra/clusters.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include "episodes/random.hpp"

namespace etlc::fit {

namespace {

constexpr int kMostRounds = 100;

struct Assignment {
    std::vector<Eigen::Index> centre;  ///< per point
    Vector squared;                    ///< per point, its squared distance to that
};

Vector squared_to(const Matrix& points, const Vector& centre) {
    return (points.colwise() - centre).colwise().squaredNorm().transpose();
}

/// k-means++: each centre is a point, drawn by its squared distance to those there are. Nothing
/// where all points are centres already.
std::optional<Matrix> seeds(const Matrix& points, Eigen::Index k, episodes::Random& random) {
    Matrix centres(points.rows(), k);
    Vector nearest = Vector::Constant(points.cols(), std::numeric_limits<double>::infinity());
    auto drawn = static_cast<Eigen::Index>(random.below(static_cast<std::uint64_t>(points.cols())));
    for (Eigen::Index c = 0;; ++c) {
        centres.col(c) = points.col(drawn);
        if (c + 1 == k) return centres;
        nearest = nearest.cwiseMin(squared_to(points, centres.col(c)));
        const double total = nearest.sum();
        if (!(total > 0)) return std::nullopt;
        double left = random.unit() * total;
        for (drawn = 0; drawn + 1 < points.cols(); ++drawn) {
            left -= nearest(drawn);
            if (left < 0) break;
        }
        while (nearest(drawn) == 0) drawn = drawn == 0 ? points.cols() - 1 : drawn - 1;
    }
}

Assignment assign(const Matrix& points, const Vector& norms, const Matrix& centres) {
    constexpr Eigen::Index kBlock = 256;
    Assignment result{std::vector<Eigen::Index>(static_cast<std::size_t>(points.cols())),
                      Vector(points.cols())};
    const Vector halves = centres.colwise().squaredNorm().transpose() / 2;
    for (Eigen::Index begin = 0; begin < points.cols(); begin += kBlock) {
        const Eigen::Index n = std::min(kBlock, points.cols() - begin);
        const Matrix closeness =
            (centres.transpose() * points.middleCols(begin, n)).colwise() - halves;
        for (Eigen::Index i = 0; i < n; ++i) {
            Eigen::Index best = 0;
            const double greatest = closeness.col(i).maxCoeff(&best);
            result.centre[static_cast<std::size_t>(begin + i)] = best;
            result.squared(begin + i) = std::max(0.0, norms(begin + i) - 2 * greatest);
        }
    }
    return result;
}

/// Means of the points of each centre. A centre without points moves to the point that is furthest
/// from its own.
Matrix means(const Matrix& points, Assignment& assignment, Eigen::Index k) {
    Matrix sums = Matrix::Zero(points.rows(), k);
    Vector counts = Vector::Zero(k);
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        const Eigen::Index c = assignment.centre[static_cast<std::size_t>(i)];
        sums.col(c) += points.col(i);
        counts(c) += 1;
    }
    for (Eigen::Index c = 0; c < k; ++c) {
        if (counts(c) > 0) {
            sums.col(c) /= counts(c);
            continue;
        }
        Eigen::Index furthest = 0;
        assignment.squared.maxCoeff(&furthest);
        assignment.squared(furthest) = 0;
        sums.col(c) = points.col(furthest);
    }
    return sums;
}

/// Lloyd's rounds until no point changes its centre.
Clusters improved(const Matrix& points, const Vector& norms, Matrix centres) {
    Assignment assignment = assign(points, norms, centres);
    for (int round = 0; round < kMostRounds; ++round) {
        Matrix moved = means(points, assignment, centres.cols());
        Assignment next = assign(points, norms, moved);
        centres = std::move(moved);
        const bool settled = next.centre == assignment.centre;
        assignment = std::move(next);
        if (settled) break;
    }
    return {std::move(centres), assignment.squared.sum()};
}

Matrix largest_first(const Matrix& centres, const Assignment& assignment) {
    std::vector<std::size_t> sizes(static_cast<std::size_t>(centres.cols()));
    for (const Eigen::Index c : assignment.centre) ++sizes[static_cast<std::size_t>(c)];
    std::vector<Eigen::Index> order(sizes.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) {
        return sizes[static_cast<std::size_t>(a)] > sizes[static_cast<std::size_t>(b)];
    });
    Matrix result(centres.rows(), centres.cols());
    for (std::size_t i = 0; i < order.size(); ++i)
        result.col(static_cast<Eigen::Index>(i)) = centres.col(order[i]);
    return result;
}

}  // namespace

std::optional<Clusters> k_means(const Matrix& points, Eigen::Index k) {
    constexpr std::uint64_t kSeed = 2026;
    if (points.cols() < k) return std::nullopt;
    const Vector middle = points.rowwise().mean();
    const Matrix centred = points.colwise() - middle;  // norms lose no digits to it
    const Vector norms = centred.colwise().squaredNorm().transpose();
    std::optional<Clusters> best;
    episodes::Random random(kSeed);
    for (int start = 0; start < kStarts; ++start) {
        auto centres = seeds(centred, k, random);
        if (!centres) return std::nullopt;
        Clusters found = improved(centred, norms, std::move(*centres));
        if (!best || found.inertia < best->inertia) best = std::move(found);
    }
    best->centres = largest_first(best->centres, assign(centred, norms, best->centres));
    best->centres.colwise() += middle;
    return best;
}

std::vector<Eigen::Index> nearest_points(const Matrix& points, const Matrix& centres) {
    std::vector<Eigen::Index> result;
    Vector taken = Vector::Zero(points.cols());
    for (Eigen::Index c = 0; c < centres.cols(); ++c) {
        Eigen::Index nearest = 0;
        (squared_to(points, centres.col(c)) + taken).minCoeff(&nearest);
        taken(nearest) = std::numeric_limits<double>::infinity();
        result.push_back(nearest);
    }
    return result;
}

}  // namespace etlc::fit
