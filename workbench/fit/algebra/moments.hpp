// Means and scatter of frames of one or two classes, in one pass. Memory is D x D, whatever the
// number of frames; the same blocks, merged in the same order, give the same bits. A scatter is
// shared by all needs for the same frames, however they classify them. Source: Chan, Golub,
// LeVeque, "Updating Formulae and a Pairwise Algorithm for Computing Sample Variances", 1979.
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "fit/algebra/dense.hpp"

namespace etlc::fit {

/// The mean of a set of frames.
struct Mean {
    std::uint64_t n = 0;
    Vector mean;

    /// Returns the mean of no frames, or of the columns.
    static Mean none(Eigen::Index dimension) { return {0, Vector::Zero(dimension)}; }
    static Mean of(const Eigen::Ref<const Matrix>& frames);
    void merge(const Mean& other);
};

/// The mean of a set of frames, and the lower triangle of the sum of (x - mean)(x - mean)^T.
struct Scatter {
    Mean all;
    Matrix lower;

    /// Computes the scatter of these frames, which it centres in place.
    void set(Eigen::Ref<Matrix> frames);
    void merge(const Scatter& other);
};
/// The class of frames at which `where` holds; the others are of class 0.
inline constexpr std::size_t kHolds = 1;

class Moments {
public:
    static constexpr std::size_t kClasses = 2;
    using Means = std::array<Mean, kClasses>;

    Moments() = default;
    explicit Moments(Eigen::Index dimension) { classes_.fill(Mean::none(dimension)); }
    /// `scatter`: of the frames of both classes; null: means only.
    Moments(Means classes, std::shared_ptr<Scatter> scatter)
        : classes_(std::move(classes)), scatter_(std::move(scatter)) {}

    void merge(const Moments& other);
    /// Merges each of `more` into that of `all`; a shared scatter is merged once.
    static void merge(const std::vector<Moments*>& all, const std::vector<const Moments*>& more);

    Eigen::Index dimension() const { return classes_[0].mean.size(); }
    std::uint64_t frames() const { return classes_[0].n + classes_[1].n; }
    std::uint64_t frames(std::size_t of_class) const { return classes_[of_class].n; }
    const Vector& mean(std::size_t of_class) const { return classes_[of_class].mean; }
    /// Returns the scatter within classes: the sum of (x - m)(x - m)^T, m being the mean of the
    /// frame's own class; D x D, lower triangle. A variance that rounding alone explains is 0.
    Matrix within() const;
    /// Returns direction^T within() direction.
    double within_along(const Vector& direction) const;
    /// Returns the number of elements that are the same in all frames.
    std::uint64_t constants() const;
    /// Returns the moments of map(x).
    Moments mapped(const Affine& map) const;

private:
    Means classes_;
    std::shared_ptr<Scatter> scatter_;  ///< copied on write where shared
};

// Linear maps computed from moments: principal components, the discriminant, logpZO. The same
// moments give the same bits. Signs are fixed: the element of greatest magnitude of a component is
// positive, and class 1 lies above class 0 along the discriminant.

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
