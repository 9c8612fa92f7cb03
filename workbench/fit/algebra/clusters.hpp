// k-means clustering, largest cluster first, and the points nearest to the centres. The same points
// in the same order give the same bits. Works on the products of pairs of points, n^2 numbers that
// are computed once for all centres and parts. Sources: Lloyd, "Least Squares Quantization in PCM",
// 1982; Arthur, Vassilvitskii, "k-means++: The Advantages of Careful Seeding", 2007.
#pragma once

#include <optional>
#include <vector>

#include "fit/algebra/dense.hpp"

namespace etlc::fit {

class Points {
public:
    Points() = default;
    /// `points`: as columns. `jobs`: threads; 0: one per core.
    explicit Points(Matrix points, unsigned jobs = 1);

    Eigen::Index size() const { return centred_.cols(); }
    Vector operator[](Eigen::Index i) const { return centred_.col(i) + middle_; }
    /// Returns the squared distance of two points.
    double squared_distance(Eigen::Index i, Eigen::Index j) const;
    const Matrix& products() const { return products_; }
    /// Returns the points minus their mean, about which products lose the fewest digits.
    const Matrix& centred() const { return centred_; }
    const Vector& middle() const { return middle_; }

private:
    Vector middle_;
    Matrix centred_;   ///< D x n
    Matrix products_;  ///< n x n
};

/// Indices of points, ascending.
using Members = std::vector<Eigen::Index>;

/// Returns the centres of these points, as columns: the best of kStarts runs. Returns nothing where
/// fewer than k points differ.
inline constexpr int kStarts = 4;
std::optional<Matrix> k_means(const Points& points, const Members& members, Eigen::Index k);

/// Returns per centre the index of the member that is nearest to it and not taken by a centre
/// before it.
std::vector<std::size_t> nearest_points(const Points& points, const Members& members,
                                        const Matrix& centres);

}  // namespace etlc::fit
