// Linear maps from moments: principal components, the discriminant, logpZO.
// Takes: moments. Gives: matrices in double. Keeps true: the same moments give the same bits;
// directions have a sign of their own: of a component the element of greatest magnitude is
// positive, along the discriminant class 1 lies above class 0.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "fit/algebra/dense.hpp"
#include "fit/algebra/moments.hpp"

namespace etlc::fit {

/// Covariance of the class kHolds, whose frames alone the moments have: scatter / (n - 1). Of this
/// and of all covariances below the lower triangle counts.
Matrix covariance(const Moments& moments);

/// The greatest variances of these frames and their directions, at least as many as asked for or
/// kLeastVariances, so that those who want few and those who want more can share them.
inline constexpr Eigen::Index kLeastVariances = 64;
struct Variances {
    Vector mean;
    Eigenpairs greatest;
    double all = 0;  ///< their sum
};
Variances greatest_variances(const Moments& moments, Eigen::Index r);

/// The r directions of greatest variance, as rows, greatest first; whitened: divided by the
/// standard deviation along them. `rank`: in how many directions the frames vary, at most r.
struct Components {
    Affine map;
    double explained = 0;  ///< part of the variance, 0 to 1
    Eigen::Index rank = 0;
};
Components principal_components(const Variances& variances, Eigen::Index r, bool whitened);

/// The covariance within both classes, W = scatter within / n, shrunk towards a multiple of the
/// identity: (1 - shrinkage) W + shrinkage tr(W) / D I. Source: Ledoit, Wolf, "A Well-Conditioned
/// Estimator for Large-Dimensional Covariance Matrices", 2004.
Matrix shrunk(const Matrix& covariance, double shrinkage);
Matrix covariance_within(const Moments& moments);

/// The inverse of it once shrunk, or nothing where it has none.
std::optional<Matrix> metric(const Moments& moments, double shrinkage);

/// One row along which the classes lie furthest apart, measured by the shrunk covariance within
/// them, which is 1 along it; 0 is midway between their means. Nothing where there is none. Source:
/// Fisher, "The Use of Multiple Measurements in Taxonomic Problems", 1936.
std::optional<Affine> discriminant(const Moments& moments, double shrinkage);

inline constexpr std::array kShrinkages = {1e-4, 1e-3, 1e-2, 0.1, 0.5};

/// Per shrinkage, how far the discriminant of some folds tells the classes of another apart: by the
/// distance of the class means over the standard deviation within classes. Nothing where there is
/// no discriminant.
using Trial = std::array<std::optional<double>, kShrinkages.size()>;
/// Tested on each of `tests`.
std::vector<Trial> trials(const Moments& training, const std::vector<const Moments*>& tests);

/// The shrinkage that does so best, on average over the trials. Nothing where fewer than two have
/// both classes.
std::optional<double> best_shrinkage(const std::vector<Trial>& trials);

/// (2.5 I - 0.5 S)(I + S)^-1 (x - mean), with S the covariance; nothing where 1 is lost beside it.
/// Source: the optimum of a rectified flow without activations, as in logpZO, "Can We Detect
/// Failures Without Failure Data?", 2025.
std::optional<Affine> logpzo(const Moments& moments);

}  // namespace etlc::fit
