// Takes up to `most` frames of an episode, evenly spaced and away from changes of the label. The
// choice depends on this episode alone, and memory on `most` and `away`. The ends of an episode are
// no changes: the label before and after is unknown.
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
    /// `away`: the least distance in steps to a frame at which `where` does not hold, less one.
    EvenFrames(std::size_t most, std::uint64_t away)
        : most_(most), away_(away), since_change_(away) {}

    /// Adds a frame at which `where` holds; without values it is missing, and is not taken.
    void add(std::uint64_t step, const std::vector<float>& values);
    /// Adds a frame at which `where` does not hold, or may not.
    void add_other();
    /// Returns the taken frames at the end of the episode.
    std::vector<TakenFrame> take();

private:
    void keep(TakenFrame frame);

    std::size_t most_;
    std::uint64_t away_;
    std::uint64_t since_change_;  ///< frames at which it held since the last change; at most `away`
    std::deque<TakenFrame> pending_;  ///< the last `away` frames, dropped when the label changes
    std::uint64_t sound_ = 0;         ///< frames eligible so far
    std::uint64_t stride_ = 1;        ///< one of so many is kept
    std::vector<TakenFrame> kept_;
};

}  // namespace etlc::fit
