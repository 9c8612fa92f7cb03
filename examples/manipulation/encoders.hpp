// Encoders of camera images.
// Takes: an image. Gives: float32 embeddings. Keeps true: the same image gives the same embedding;
// nothing is fitted to a task: pixels and random convolutions are not trained at all, the trained
// ones (train.cpp) saw images without a label.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "simulator.hpp"

namespace manipulation {

/// The mean colour of each of 16 x 16 squares: 768 numbers in [0, 1].
Eigen::VectorXf encode_pixels(const Image& image);

/// Filters of width x width pixels at every stride-th pixel, then ReLU; outside the image is 0.
struct Convolution {
    Eigen::Index width = 0;
    Eigen::Index stride = 1;
    Eigen::MatrixXf filters;  ///< one column each; rows are ordered by y, x, channel
    Eigen::RowVectorXf bias;  ///< one number per filter
};

/// Two layers of convolutions with random filters, then means over 4 x 4 squares: 512 numbers.
/// Random filters preserve positions, like trained ones (Jarrett, Kavukcuoglu, Ranzato, LeCun:
/// "What is the best multi-stage architecture for object recognition?", 2009).
class RandomConvolutions {
public:
    explicit RandomConvolutions(std::uint64_t seed);
    Eigen::VectorXf encode(const Image& image) const;

private:
    std::array<Convolution, 2> layers_;
};

/// The layers of an encoder from train.cpp, the first half of an autoencoder.
struct LayerShape {
    int width;
    int stride;
    int filters;
};
inline constexpr std::array<LayerShape, 4> kTrainedLayers{
    {{5, 2, 16}, {3, 2, 32}, {3, 2, 32}, {3, 2, 32}}};
inline constexpr int kTrainedSide = kSide / 16;  ///< filters of the last layer
inline constexpr int kTrainedCode = 128;         ///< numbers per embedding

/// Four layers of trained convolutions, then a linear map to 128 numbers.
class TrainedConvolutions {
public:
    /// Reads a file of float32: filters and bias of each layer, then the map's matrix, column by
    /// column, and its bias. Throws std::runtime_error if it cannot be read or has another size.
    explicit TrainedConvolutions(const std::string& path);
    Eigen::VectorXf encode(const Image& image) const;

private:
    std::array<Convolution, kTrainedLayers.size()> layers_;
    Convolution last_;  ///< over the whole last map; without ReLU
};

}  // namespace manipulation
