// A small learned encoder: blur, then principal components.
// Takes: camera images. Gives: embeddings of 32 float32 numbers, the `input z` of dubins.etl. Keeps
// true: the same components encode the targets and the frames, so their distances are meaningful.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "camera.hpp"

namespace demo {

inline constexpr int kDimension = 32;
using Embedding = std::array<float, kDimension>;

/// Returns ink (1 where the image is black) averaged over 2 x 2 pixels and blurred, row by row.
Eigen::VectorXf blurred(const Image& image);

class Encoder {
public:
    /// Computes principal components of the blurred images (PCA by the eigenvectors of their
    /// covariance).
    static Encoder fit(const std::vector<Image>& images);
    /// Reads `mean.npy` (1 x 1024) and `components.npy` (32 x 1024). Throws std::runtime_error with
    /// the reason.
    static Encoder load(const std::string& folder);

    void save(const std::string& folder) const;
    Embedding encode(const Image& image) const;

    /// The fraction of the images' variance that the components keep; known after fit.
    double kept_variance() const { return kept_; }

private:
    Eigen::VectorXf mean_;
    Eigen::MatrixXf components_;  ///< orthonormal rows
    double kept_ = 0;
};

}  // namespace demo
