// Collects frames in blocks and turns them into moments. Frames that several needs share are
// scattered once; memory is that of a block.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "fit/algebra/moments.hpp"

namespace etlc::fit {

class Blocks {
public:
    /// The class of a frame that counts in none.
    static constexpr std::int8_t kNone = -1;

    /// `with_scatter`: per need.
    Blocks(Eigen::Index dimension, std::vector<bool> with_scatter);

    /// `classes`: per need.
    void add(const std::vector<float>& point, const std::vector<std::int8_t>& classes);
    /// Returns the moments of all frames since the last call, per need.
    std::vector<Moments> take();

private:
    void flush();
    std::shared_ptr<Scatter> scatter(const std::vector<bool>& selected);
    std::shared_ptr<Scatter> unused_scatter();
    Mean mean(std::size_t need, std::size_t of_class) const;

    static constexpr Eigen::Index kFrames = 512;

    Eigen::MatrixXf frames_;  ///< frames, as columns
    Eigen::Index filled_ = 0;
    std::vector<bool> with_scatter_;
    std::vector<std::vector<std::int8_t>> classes_;  ///< per need, then per frame of the block
    std::vector<Moments> moments_;
    // These are large, so they are allocated once.
    Matrix selected_;                                 ///< frames
    std::vector<std::shared_ptr<Scatter>> scatters_;  ///< may be in use by moments
};

}  // namespace etlc::fit
