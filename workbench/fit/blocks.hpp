// Frames of an episode, a block at a time, made into moments.
// Takes: a point at every frame, and the class that each need puts the frame in. Gives: the moments
// of each need. Keeps true: frames that several needs ask about are scattered once; memory is that
// of a block.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "fit/algebra/moments.hpp"

namespace etlc::fit {

class Blocks {
public:
    /// Of a frame that is in no class of the need.
    static constexpr std::int8_t kNone = -1;

    /// `with_scatter`: per need.
    Blocks(Eigen::Index dimension, std::vector<bool> with_scatter);

    /// `classes`: per need.
    void add(const std::vector<float>& point, const std::vector<std::int8_t>& classes);
    /// Of all since the last call, per need.
    std::vector<Moments> take();

private:
    void flush();
    std::shared_ptr<Scatter> scatter(const std::vector<bool>& selected);
    std::shared_ptr<Scatter> unused_scatter();
    Mean mean(std::size_t need, std::size_t of_class) const;

    static constexpr Eigen::Index kFrames = 512;

    Eigen::MatrixXf frames_;  ///< as columns
    Eigen::Index filled_ = 0;
    std::vector<bool> with_scatter_;
    std::vector<std::vector<std::int8_t>> classes_;  ///< per need, then per frame of the block
    std::vector<Moments> moments_;
    // Large, and so made once.
    Matrix selected_;                                 ///< frames
    std::vector<std::shared_ptr<Scatter>> scatters_;  ///< some of them in use
};

}  // namespace etlc::fit
