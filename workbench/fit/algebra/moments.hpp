// Means and scatter of frames, of one or two classes, in one pass.
// Takes: blocks of frames. Gives: per class its number of frames and mean, and the scatter of all
// and within the classes. Keeps true: memory is D x D, not frames; the same blocks, merged in the
// same order, give the same bits. What was scattered once is shared by all who ask about the same
// frames, however they class them. Source: Chan, Golub, LeVeque, "Updating Formulae and a Pairwise
// Algorithm for Computing Sample Variances", 1979.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "fit/algebra/dense.hpp"

namespace etlc::fit {

/// Of a set of frames.
struct Mean {
    std::uint64_t n = 0;
    Vector mean;

    /// Of no frames, or of the columns.
    static Mean none(Eigen::Index dimension) { return {0, Vector::Zero(dimension)}; }
    static Mean of(const Eigen::Ref<const Matrix>& frames);
    void merge(const Mean& other);
};

/// Of a set of frames, with the lower triangle of the sum of (x - mean)(x - mean)^T.
struct Scatter {
    Mean all;
    Matrix lower;

    /// That of these frames, which change.
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
    /// `scatter`: of the frames of both; null: they have the means alone.
    Moments(Means classes, std::shared_ptr<Scatter> scatter)
        : classes_(std::move(classes)), scatter_(std::move(scatter)) {}

    void merge(const Moments& other);
    /// Each of the second into that of the first; what they share is merged once.
    static void merge(const std::vector<Moments*>& all, const std::vector<const Moments*>& more);

    Eigen::Index dimension() const { return classes_[0].mean.size(); }
    std::uint64_t frames() const { return classes_[0].n + classes_[1].n; }
    std::uint64_t frames(std::size_t of_class) const { return classes_[of_class].n; }
    const Vector& mean(std::size_t of_class) const { return classes_[of_class].mean; }
    /// Within the classes: the sum of (x - m)(x - m)^T, m being the mean of the frame's own class;
    /// D x D, the lower triangle of what is symmetric. A variance that is no more than rounding
    /// leaves of none is 0.
    Matrix within() const;
    /// direction^T within() direction.
    double within_along(const Vector& direction) const;
    /// Elements that are the same in all frames.
    std::uint64_t constants() const;
    /// Of map(x).
    Moments mapped(const Affine& map) const;

private:
    Means classes_;
    std::shared_ptr<Scatter> scatter_;  ///< copied before it changes, where others share it
};

}  // namespace etlc::fit
