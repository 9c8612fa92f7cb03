#include "encoder.hpp"

#include <algorithm>
#include <cmath>

#include "npy.hpp"

namespace demo {
namespace {

constexpr int kSide = kImageSide / 2;  // the images are halved first
constexpr int kPixels = kSide * kSide;
constexpr double kBlur = 2.0;  // standard deviation, in pixels of the halved image: 0.19 m

using Frame = Eigen::Matrix<float, kSide, kSide, Eigen::RowMajor>;

/// Gaussian weights between the rows (or columns) of an image.
const Frame& gaussian() {
    static const Frame weights = [] {
        Frame w;
        for (int i = 0; i < kSide; ++i) {
            for (int j = 0; j < kSide; ++j) {
                w(i, j) = static_cast<float>(std::exp(-0.5 * (i - j) * (i - j) / (kBlur * kBlur)));
            }
        }
        return Frame(w / w.row(kSide / 2).sum());
    }();
    return weights;
}

}  // namespace

Eigen::VectorXf blurred(const Image& image) {
    using Pixels = Eigen::Matrix<std::uint8_t, kImageSide, kImageSide, Eigen::RowMajor>;
    const Eigen::Map<const Pixels> grey(image.data());
    Frame ink;
    for (int row = 0; row < kSide; ++row) {
        for (int column = 0; column < kSide; ++column) {
            const int sum = grey.block<2, 2>(2 * row, 2 * column).cast<int>().sum();
            ink(row, column) = 1.0F - static_cast<float>(sum) / (4 * 255.0F);
        }
    }
    const Frame soft = gaussian() * ink * gaussian();
    return Eigen::Map<const Eigen::VectorXf>(soft.data(), kPixels);
}

Encoder Encoder::load(const std::string& folder) {
    Encoder encoder;
    encoder.mean_ = read_matrix(folder + "/mean.npy", 1, kPixels).row(0);
    encoder.components_ = read_matrix(folder + "/components.npy", kDimension, kPixels);
    return encoder;
}

void Encoder::save(const std::string& folder) const {
    write_matrix(folder + "/mean.npy", mean_.transpose());
    write_matrix(folder + "/components.npy", components_);
}

Embedding Encoder::encode(const Image& image) const {
    Embedding embedding;
    Eigen::Map<Eigen::Matrix<float, kDimension, 1>>(embedding.data()) =
        components_ * (blurred(image) - mean_);
    return embedding;
}

}  // namespace demo
