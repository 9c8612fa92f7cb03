// Some frames of each episode, taken evenly, and away from where a truth changes.
// Takes: the frames of an episode with their labels. Gives: up to `most` of them. Keeps true: what
// is taken depends on this episode alone, and memory on `most` and `away`, not on the episode's
// length. Its first and last frame are no change of the truth: nobody knows what was before.
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

namespace etlc::fit {

struct TakenFrame {
    std::uint64_t step = 0;
    std::vector<float> values;
};

class EvenFrames {
public:
    /// `away`: least number of steps to a frame at which `where` does not hold, less one.
    EvenFrames(std::size_t most, std::uint64_t away)
        : most_(most), away_(away), since_change_(away) {}

    /// A frame at which it holds; no values: it is missing, and is not taken.
    void add(std::uint64_t step, const std::vector<float>& values);
    /// One at which it does not, or may not.
    void add_other();
    /// At the end of the episode.
    std::vector<TakenFrame> take();

private:
    void keep(TakenFrame frame);

    std::size_t most_;
    std::uint64_t away_;
    std::uint64_t since_change_;      ///< frames since then at which it has held; at most `away`
    std::deque<TakenFrame> pending_;  ///< the last `away` of them, which a change would void
    std::uint64_t sound_ = 0;         ///< frames that could be taken so far
    std::uint64_t stride_ = 1;        ///< every so many of them are kept
    std::vector<TakenFrame> kept_;
};

}  // namespace etlc::fit
