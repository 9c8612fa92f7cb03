// Cluster centres, and the frames nearest to them.
// Takes: points, as columns. Gives: k centres, largest cluster first. Keeps true: the same points
// in the same order give the same bits. Sources: Lloyd, "Least Squares Quantization in PCM", 1982;
// Arthur, Vassilvitskii, "k-means++: The Advantages of Careful Seeding", 2007.
#pragma once

#include <optional>
#include <vector>

#include "fit/algebra/affine.hpp"

namespace etlc::fit {

struct Clusters {
    Matrix centres;      ///< D x k
    double inertia = 0;  ///< sum of the squared distances of the points to their nearest centre
};

/// The best of kStarts. Nothing where there are fewer than k different points.
inline constexpr int kStarts = 4;
std::optional<Clusters> k_means(const Matrix& points, Eigen::Index k);

/// Per centre the index of the point nearest to it that is nearest to no centre before it.
std::vector<Eigen::Index> nearest_points(const Matrix& points, const Matrix& centres);

}  // namespace etlc::fit
