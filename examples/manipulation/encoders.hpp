// What turns camera images into embeddings, without training.
// Takes: an image. Gives: float32 embeddings. Keeps true: the same image gives the same embedding;
// nothing is fitted to the tasks.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "simulator.hpp"

namespace manipulation {

/// The mean colour of each of 16 x 16 squares: 768 numbers in [0, 1].
Eigen::VectorXf encode_pixels(const Image& image);

/// Two layers of convolutions with random filters and ReLU, then means over 4 x 4 squares: 512
/// numbers. Random filters keep what is where, as trained ones do (Jarrett, Kavukcuoglu, Ranzato,
/// LeCun: "What is the best multi-stage architecture for object recognition?", 2009).
class RandomConvolutions {
public:
    explicit RandomConvolutions(std::uint64_t seed);
    Eigen::VectorXf encode(const Image& image) const;

private:
    Eigen::MatrixXf first_;   ///< 7 x 7 x 3 by 16
    Eigen::MatrixXf second_;  ///< 5 x 5 x 16 by 32
};

}  // namespace manipulation
