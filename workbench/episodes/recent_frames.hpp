// Points of the frames of an episode, as they were recorded: of the last frame, and of those before
// it that points of earlier steps need.
#pragma once

#include <cstddef>
#include <deque>
#include <vector>

#include "check/model/model.hpp"
#include "execute/inputs.hpp"

namespace etlc::episodes {

using check::Index;

class RecentFrames {
public:
    /// `points`: those that will be read, without projections inside of what is put together.
    RecentFrames(const check::Model& model, const std::vector<Index>& points);

    /// Begins another episode.
    void reset() {
        last_ = nullptr;
        frames_.clear();
    }
    /// Adds a frame; per input of the model its sample. The samples of the last frame outlive the
    /// calls of `read`: they are copied only where points of earlier steps need them.
    void push(const std::vector<execute::Sample>& samples);
    /// Reads a point at the last frame; returns false where a sample is missing, or not finite or
    /// in range.
    bool read(Index point, std::vector<float>& values) const;

private:
    bool append(Index point, std::size_t ago, std::vector<float>& values) const;

    const std::vector<execute::Sample>* at(std::size_t ago) const;

    const check::Model& model_;
    std::vector<Index> inputs_;
    std::size_t most_ = 0;  ///< frames before the last that some point needs
    const std::vector<execute::Sample>* last_ = nullptr;
    std::deque<std::vector<execute::Sample>> frames_;  ///< if most_ > 0; the last one first
};

}  // namespace etlc::episodes
