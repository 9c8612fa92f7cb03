// The frames of an episode, one after the other, wherever they come from: a file
// (episodes/recording.hpp), or memory. Takes: nothing. Gives: per frame the samples in the
// monitor's precision and the labels of predicates. Keeps true: those who go through an episode
// need not know where it lies.
#pragma once

#include <cstdint>
#include <vector>

#include "check/model/model.hpp"
#include "diag/diag.hpp"
#include "episodes/truth.hpp"
#include "plan/evaluate/inputs.hpp"

namespace etlc::episodes {

class Frames {
public:
    virtual ~Frames() = default;

    /// The next frame; false at the end of the episode.
    virtual diag::Result<bool> next() = 0;
    /// Of this frame, by index of the model's inputs; those not wanted are not there.
    virtual const std::vector<plan::Sample>& samples() const = 0;
    /// Of this frame: one of the wanted predicates.
    virtual Label label(Index predicate) const = 0;
    /// How many there were so far.
    virtual std::uint64_t frames() const = 0;

protected:
    Frames() = default;
    Frames(const Frames&) = default;
    Frames(Frames&&) = default;
    Frames& operator=(const Frames&) = default;
    Frames& operator=(Frames&&) = default;
};

}  // namespace etlc::episodes
