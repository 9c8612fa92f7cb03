// Linear maps from moments: principal components, the discriminant, logpZO.
// Takes: moments. Gives: matrices in double. Keeps true: the same moments give the same bits;
// directions have a sign of their own: of a component the element of greatest magnitude is
// positive, along the discriminant class 1 lies above class 0.
#pragma once

#include <optional>
#include <vector>

#include "fit/moments.hpp"

namespace etlc::fit {

/// The class of frames at which `where` holds; the others are of class 0.
inline constexpr std::size_t kHolds = 1;

/// Covariance of the class kHolds, whose frames alone the moments have: scatter / (n - 1).
Matrix covariance(const Moments& moments);

/// The r directions of greatest variance, as rows, greatest first; whitened: divided by the
/// standard deviation along them. `rank`: in how many directions the frames vary.
struct Components {
    Affine map;
    double explained = 0;  ///< part of the variance, 0 to 1
    Eigen::Index rank = 0;
};
Components principal_components(const Moments& moments, Eigen::Index r, bool whitened);

/// The within-class covariance W, shrunk towards a multiple of the identity: (1 - shrinkage) W +
/// shrinkage tr(W) / D I, where W = scatter / n. Source: Ledoit, Wolf, "A Well-Conditioned
/// Estimator for Large-Dimensional Covariance Matrices", 2004.
Matrix shrunk_covariance(const Moments& moments, double shrinkage);

/// The inverse of it, or nothing where it has none.
std::optional<Matrix> metric(const Moments& moments, double shrinkage);

/// One row along which the classes lie furthest apart, measured by the shrunk covariance within
/// them, which is 1 along it; 0 is midway between their means. Nothing where there is none. Source:
/// Fisher, "The Use of Multiple Measurements in Taxonomic Problems", 1936.
std::optional<Affine> discriminant(const Moments& moments, double shrinkage);

/// The shrinkage, of kShrinkages, with which the discriminant of all folds but one tells the
/// classes of that one apart best: by the distance of the class means over the standard deviation
/// within classes, on average over the folds. Nothing where fewer than two folds have both.
inline constexpr double kShrinkages[] = {1e-4, 1e-3, 1e-2, 0.1, 0.5};
std::optional<double> best_shrinkage(const std::vector<const Moments*>& folds);

/// (2.5 I - 0.5 S)(I + S)^-1 (x - mean), with S the covariance. Source: the optimum of a rectified
/// flow without activations, as in logpZO, "Can We Detect Failures Without Failure Data?", 2025.
Affine logpzo(const Moments& moments);

}  // namespace etlc::fit
