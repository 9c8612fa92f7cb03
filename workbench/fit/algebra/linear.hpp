// Linear maps computed from moments: principal components, the discriminant, logpZO. The same
// moments give the same bits. Signs are fixed: the element of greatest magnitude of a component is
// positive, and class 1 lies above class 0 along the discriminant.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "fit/algebra/dense.hpp"
#include "fit/algebra/moments.hpp"

namespace etlc::fit {

/// Returns the covariance of the class kHolds, scatter / (n - 1), where the moments have no others.
/// All covariances here have a valid lower triangle only.
Matrix covariance(const Moments& moments);

/// The greatest variances of the frames and their directions: at least as many as requested or
/// kLeastVariances, so that requests for few and for more can share them.
inline constexpr Eigen::Index kLeastVariances = 64;
struct Variances {
    Vector mean;
    Eigenpairs greatest;
    double all = 0;  ///< sum of all variances
};
Variances greatest_variances(const Moments& moments, Eigen::Index r);

/// The r directions of greatest variance, as rows, in descending order; if whitened, divided by the
/// standard deviation along them. `rank`: directions in which the frames vary, at most r.
struct Components {
    Affine map;
    double explained = 0;  ///< share of the variance
    Eigen::Index rank = 0;
};
Components principal_components(const Variances& variances, Eigen::Index r, bool whitened);

/// Shrinks the covariance W within classes, scatter / n, towards a multiple of the identity: (1 -
/// shrinkage) W + shrinkage tr(W) / D I. Source: Ledoit, Wolf, "A Well-Conditioned Estimator for
/// Large-Dimensional Covariance Matrices", 2004.
Matrix shrunk(const Matrix& covariance, double shrinkage);
Matrix covariance_within(const Moments& moments);

/// Returns the inverse of the shrunk covariance, or nothing where it is singular.
std::optional<Matrix> metric(const Moments& moments, double shrinkage);

/// Returns one row along which the classes lie furthest apart, scaled so that the shrunk covariance
/// within classes is 1 along it; 0 is midway between their means. Returns nothing where the
/// covariance is singular or the means are equal. Source: Fisher, "The Use of Multiple Measurements
/// in Taxonomic Problems", 1936.
std::optional<Affine> discriminant(const Moments& moments, double shrinkage);

inline constexpr std::array kShrinkages = {1e-4, 1e-3, 1e-2, 0.1, 0.5};

/// Per shrinkage, how well the discriminant of some folds separates another: the distance of the
/// class means over the standard deviation within classes. Nothing where there is no discriminant.
using Trial = std::array<std::optional<double>, kShrinkages.size()>;
/// Tests the discriminant of `training` on each of `tests`.
std::vector<Trial> trials(const Moments& training, const std::vector<const Moments*>& tests);

/// Returns the shrinkage that separates best on average; nothing where fewer than two trials have
/// both classes.
std::optional<double> best_shrinkage(const std::vector<Trial>& trials);

/// Returns (2.5 I - 0.5 S)(I + S)^-1 (x - mean), with S the covariance; nothing where I vanishes
/// beside S. Source: the optimum of a rectified flow without activations, as in logpZO, "Can We
/// Detect Failures Without Failure Data?", 2025.
std::optional<Affine> logpzo(const Moments& moments);

}  // namespace etlc::fit
