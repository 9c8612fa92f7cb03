// Means and scatter of frames of one or two classes, in one pass. Memory is D x D, whatever the
// number of frames; the same blocks, merged in the same order, give the same bits. A scatter is
// shared by all needs for the same frames, however they classify them. Source: Chan, Golub,
// LeVeque, "Updating Formulae and a Pairwise Algorithm for Computing Sample Variances", 1979.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
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

}  // namespace etlc::fit
