// Frames of episodes in memory, for those who go through them again.
// Takes: the frames of an episode as they are read, and room that all episodes share. Gives: the
// same frames, as often as wanted. Keeps true: all that is kept together fits the room; an episode
// is kept as a whole or not at all.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "episodes/recording.hpp"

namespace etlc::fit {

using check::Index;

/// Bytes that are free. Any number of threads may use it at once.
class Room {
public:
    explicit Room(std::size_t bytes) : left_(bytes) {}

    /// `count` times `bytes`; false where there are not as many.
    bool take(std::uint64_t count, std::size_t bytes);
    void give_back(std::size_t bytes) { left_ += bytes; }

private:
    std::atomic<std::size_t> left_;
};

/// An episode that is kept.
struct Kept {
    std::vector<float> values;            ///< of the wanted inputs that are there, in order
    std::vector<bool> present;            ///< per frame and wanted input
    std::vector<episodes::Label> labels;  ///< per frame and wanted predicate
    std::uint64_t frames = 0;
};

/// Keeps an episode while it is read.
class Keeper {
public:
    /// All that it is given outlives it.
    Keeper(const episodes::Wanted& wanted, Room& room);

    /// Its next frame.
    void add(const episodes::Recording& recording);
    /// At the end; null: there was no room for it.
    std::shared_ptr<const Kept> take();

private:
    /// For the next frames, of so many in the episode; 0: not known. False: there is no room.
    bool make_places(std::uint64_t length);
    void forget();

    const episodes::Wanted& wanted_;
    Room& room_;
    std::size_t bytes_ = 0;     ///< of a frame
    std::uint64_t places_ = 0;  ///< frames that there is room for
    std::shared_ptr<Kept> kept_;
};

/// What was kept, once more.
class KeptFrames final : public episodes::Frames {
public:
    /// `wanted`: as it was kept; outlives it.
    KeptFrames(const episodes::Wanted& wanted, std::shared_ptr<const Kept> kept);

    diag::Result<bool> next() override;
    const std::vector<plan::Sample>& samples() const override { return samples_; }
    episodes::Label label(Index predicate) const override;
    std::uint64_t frames() const override { return frames_; }

private:
    const episodes::Wanted& wanted_;
    std::shared_ptr<const Kept> kept_;
    std::vector<std::size_t> places_;  ///< per predicate of the model, among those wanted
    std::vector<plan::Sample> samples_;
    std::size_t at_ = 0;  ///< among the values: those of the next frame
    std::uint64_t frames_ = 0;
};

}  // namespace etlc::fit
