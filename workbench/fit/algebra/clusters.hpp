// Cluster centres, and the frames nearest to them.
// Takes: points, as columns. Gives: k centres, largest cluster first. Keeps true: the same points
// in the same order give the same bits. All goes by the products of pairs of points, which are
// computed once: n^2 numbers, however many centres and parts are asked for. Sources: Lloyd, "Least
// Squares Quantization in PCM", 1982; Arthur, Vassilvitskii, "k-means++: The Advantages of Careful
// Seeding", 2007.
#pragma once

#include <optional>
#include <vector>

#include "fit/algebra/dense.hpp"

namespace etlc::fit {

class Points {
public:
    Points() = default;
    explicit Points(const Matrix& points);

    Eigen::Index size() const { return centred_.cols(); }
    Vector operator[](Eigen::Index i) const { return centred_.col(i) + middle_; }
    /// Of two points.
    double squared_distance(Eigen::Index i, Eigen::Index j) const;
    const Matrix& products() const { return products_; }
    /// From their mean, about which products lose the fewest digits.
    const Matrix& centred() const { return centred_; }
    const Vector& middle() const { return middle_; }

private:
    Vector middle_;
    Matrix centred_;   ///< D x n
    Matrix products_;  ///< n x n
};

/// Numbers of points, ascending.
using Members = std::vector<Eigen::Index>;

/// The centres of these points, as columns: the best of kStarts. Nothing where there are fewer than
/// k different points.
inline constexpr int kStarts = 4;
std::optional<Matrix> k_means(const Points& points, const Members& members, Eigen::Index k);

/// Per centre which of the members is nearest to it, and to no centre before it.
std::vector<std::size_t> nearest_points(const Points& points, const Members& members,
                                        const Matrix& centres);

}  // namespace etlc::fit
