// The samples of an episode as the monitor sees them, by which episodes are told apart.
// Takes: the samples of the inputs that count, a frame after the other. Gives: a hash of the
// episode, and what tells whether another is the same recording. Keeps true: two files of one
// recording are the same where the monitor could not tell them apart, whatever they are stored in:
// a float16 is rounded, a sample that counts as missing is missing however that is written, `hold`
// replaces it, a bool is true or false, and a zero has no sign.
#pragma once

#include <cstdint>
#include <vector>

#include "check/model/model.hpp"
#include "data/recordings/episodes.hpp"
#include "plan/evaluate/inputs.hpp"

namespace etlc::episodes {

using check::Index;

class Seen {
public:
    /// The model outlives it.
    Seen(const check::Model& model, std::vector<Index> inputs);

    /// The next frame; `samples`: by index of the model's inputs.
    void add(const std::vector<plan::Sample>& samples);
    /// Of the frames so far.
    const data::EpisodeHash& hash() const { return hash_; }

private:
    struct Held {
        std::vector<float> values;
        std::uint32_t age = 0;  ///< missing samples since
    };
    void see(const check::Input& input, const plan::Sample& sample, Held& held,
             std::vector<float>& seen) const;

    const check::Model& model_;
    std::vector<Index> inputs_;
    std::vector<Held> held_;                ///< per input, the last present sample
    std::vector<std::vector<float>> seen_;  ///< per input, of this frame; empty: missing
    data::EpisodeHash hash_;
};

}  // namespace etlc::episodes
