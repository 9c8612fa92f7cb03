// Mean and scatter of frames, of one or two classes, in one pass.
// Takes: blocks of frames. Gives: per class its number of frames and mean, and the sum over all
// frames of (x - m)(x - m)^T, where m is the mean of the frame's own class. Keeps true: memory is D
// x D, not frames; the same blocks, merged in the same order, give the same bits. Source: Chan,
// Golub, LeVeque, "Updating Formulae and a Pairwise Algorithm for Computing Sample Variances",
// 1979.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "fit/affine.hpp"

namespace etlc::fit {

class Moments {
public:
    static constexpr std::size_t kClasses = 2;

    Moments() = default;
    /// Without its scatter it is the means alone.
    Moments(Eigen::Index dimension, bool with_scatter);

    /// Frames are columns. Changes them.
    void add(std::size_t of_class, Eigen::Ref<Matrix> frames);
    void merge(const Moments& other);

    Eigen::Index dimension() const { return classes_[0].mean.size(); }
    std::uint64_t frames() const { return classes_[0].n + classes_[1].n; }
    std::uint64_t frames(std::size_t of_class) const { return classes_[of_class].n; }
    const Vector& mean(std::size_t of_class) const { return classes_[of_class].mean; }
    /// D x D, symmetric.
    Matrix scatter() const;
    /// Of map(x).
    Moments mapped(const Affine& map) const;

private:
    struct Class {
        std::uint64_t n = 0;
        Vector mean;
    };

    /// Of one more set of frames of a class, whose own scatter is added by the caller.
    void move_mean(std::size_t of_class, std::uint64_t n, const Vector& mean);

    std::array<Class, kClasses> classes_;
    Matrix scatter_;  ///< its lower triangle; without: 0 x 0
};

}  // namespace etlc::fit
