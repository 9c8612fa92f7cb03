#include "encoder.hpp"

#include <Eigen/Eigenvalues>
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

/// Ink (1 where the image is black) averaged over 2 x 2 pixels and blurred, row by row.
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

}  // namespace

Encoder Encoder::fit(const std::vector<Image>& images) {
    Eigen::MatrixXf rows(static_cast<Eigen::Index>(images.size()), kPixels);
    for (std::size_t i = 0; i < images.size(); ++i)
        rows.row(static_cast<Eigen::Index>(i)) = blurred(images[i]);

    Encoder encoder;
    encoder.mean_ = rows.colwise().mean();
    rows.rowwise() -= encoder.mean_.transpose();
    const Eigen::MatrixXd covariance =
        (rows.transpose() * rows).cast<double>() / static_cast<double>(images.size());
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance);  // eigenvalues ascend
    encoder.components_ =
        solver.eigenvectors().rightCols(kDimension).rowwise().reverse().transpose().cast<float>();
    encoder.kept_ = solver.eigenvalues().tail(kDimension).sum() / solver.eigenvalues().sum();
    return encoder;
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
