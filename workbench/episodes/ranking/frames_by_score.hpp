// Labelled frames by their score, of which any number takes little memory.
// Takes: the frames, in any order. Gives: them in ascending order of the score, as often as asked
// for; of equal scores those of an episode stand together. Keeps true: memory is that of
// data::Sorted.
#pragma once

#include <bit>
#include <cstdint>

#include "data/spill/sorted.hpp"

namespace etlc::episodes {

struct Scored {
    float score = 0;  ///< not NaN
    std::uint32_t episode = 0;
    bool positive = false;
};

template <class Archive>
void fields(Archive& archive, Scored& frame) {
    archive(frame.score, frame.episode, frame.positive);
}

class FramesByScore {
public:
    /// First all are added. Fewer than 2^31 episodes.
    void add(const Scored& frame) {
        positives_ += frame.positive ? 1 : 0;
        const std::uint32_t rest = frame.episode << 1U | (frame.positive ? 1U : 0U);
        keys_.add(std::uint64_t{key_of(frame.score)} << 32U | rest);
    }

    std::uint64_t size() const { return keys_.size(); }
    std::uint64_t positives() const { return positives_; }
    std::uint64_t negatives() const { return size() - positives_; }

    /// Calls `visit(frame)` for each; a score of -0 is 0.
    template <class Visit>
    void for_each(const Visit& visit) const {
        keys_.for_each([&](std::uint64_t key) {
            const auto rest = static_cast<std::uint32_t>(key);
            visit(Scored{score_of(static_cast<std::uint32_t>(key >> 32U)), rest >> 1U,
                         (rest & 1U) != 0});
        });
    }

private:
    static constexpr std::uint32_t kSign = 1U << 31U;

    /// Ordered as the scores are.
    static std::uint32_t key_of(float score) {
        const auto bits = std::bit_cast<std::uint32_t>(score == 0 ? 0.0F : score);
        return (bits & kSign) != 0 ? ~bits : bits | kSign;
    }
    static float score_of(std::uint32_t key) {
        return std::bit_cast<float>((key & kSign) != 0 ? key & ~kSign : ~key);
    }

    data::Sorted<std::uint64_t> keys_;
    std::uint64_t positives_ = 0;
};

}  // namespace etlc::episodes
