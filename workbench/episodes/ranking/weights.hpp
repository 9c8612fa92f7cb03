// How often each episode counts.
// Takes: a number of episodes and of resamples. Gives: of each episode its weight in every
// resample, which stand side by side, so that sums of all resamples are made in one pass.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace etlc::episodes {

class Weights {
public:
    using Weight = std::uint16_t;

    /// In every resample each episode counts `weight` times.
    Weights(std::size_t episodes, std::size_t resamples, Weight weight)
        : resamples_(resamples), weights_(episodes * resamples, weight) {}

    std::size_t resamples() const { return resamples_; }
    std::size_t episodes() const { return resamples_ == 0 ? 0 : weights_.size() / resamples_; }
    /// Of an episode, one for each resample.
    const Weight* operator[](std::size_t episode) const {
        return weights_.data() + episode * resamples_;
    }
    Weight* operator[](std::size_t episode) { return weights_.data() + episode * resamples_; }

private:
    std::size_t resamples_;
    std::vector<Weight> weights_;  ///< by episode, then by resample
};

}  // namespace etlc::episodes
