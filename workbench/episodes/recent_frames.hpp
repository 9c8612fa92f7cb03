// Points of the frames of an episode, as they were recorded: of the last frame, and of those before
// it that points of earlier steps need.
#pragma once

#include <cstddef>
#include <deque>
#include <vector>

#include "check/model/model.hpp"
#include "plan/evaluate/inputs.hpp"

namespace etlc::episodes {

using check::Index;

class RecentFrames {
public:
    /// `points`: those that will be read, without projections inside of what is put together.
    RecentFrames(const check::Model& model, const std::vector<Index>& points);

    /// Begins another episode.
    void reset() { frames_.clear(); }
    /// Adds a frame; per input of the model its sample.
    void push(const std::vector<plan::Sample>& samples);
    /// Reads a point at the last frame; returns false where a sample is missing, or not finite or
    /// in range.
    bool read(Index point, std::vector<float>& values) const;

private:
    bool append(Index point, std::size_t ago, std::vector<float>& values) const;

    const check::Model& model_;
    std::vector<Index> inputs_;
    std::size_t most_ = 0;  ///< frames before the last that some point needs
    std::deque<std::vector<plan::Sample>> frames_;  ///< the last one first
};

}  // namespace etlc::episodes
