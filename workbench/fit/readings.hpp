// Reads the episodes of a call once, in the order of their content, and gives their frames again
// for later passes. Neither names of files nor the order of arguments count. Episodes that fit into
// `most_kept` bytes stay in memory; the others are read again.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "check/guarantees/provenance.hpp"
#include "data/recordings/open.hpp"
#include "diag/diag.hpp"
#include "episodes/recording.hpp"

namespace etlc::fit {

/// The arguments of `etlc fit`.
struct Request {
    std::vector<std::string> episodes;  ///< as data::find_episodes gives them
    episodes::ReadOptions reading;
    /// The reason of --allow-overlap; empty without the option.
    std::string allow_overlap;
    unsigned jobs = 0;  ///< threads; 0: as many as the machine has
    /// Whether to measure how well predicates separate frames that were not fitted on, which takes
    /// another fit without each fold.
    bool separation = true;
    std::string version;  ///< version of etlc
    /// Called by any thread, one at a time.
    std::function<void(std::size_t done, std::size_t total)> progress;
    /// The most bytes of frames to keep in memory, over all episodes.
    std::size_t most_kept = std::size_t{256} << 20U;
};

using check::Index;

/// A thread-safe count of free bytes.
class Room {
public:
    explicit Room(std::size_t bytes) : left_(bytes) {}

    /// Takes `count` times `bytes`; returns false where fewer are free.
    bool take(std::uint64_t count, std::size_t bytes);
    void give_back(std::size_t bytes) { left_ += bytes; }

private:
    std::atomic<std::size_t> left_;
};

/// The frames of an episode that is kept in memory.
struct Kept {
    std::vector<float> values;            ///< of the wanted inputs that are present, in order
    std::vector<bool> present;            ///< per frame and wanted input
    std::vector<episodes::Label> labels;  ///< per frame and wanted predicate
    std::uint64_t frames = 0;
};

/// Keeps an episode while it is read.
class Keeper {
public:
    /// The arguments outlive the keeper.
    Keeper(const episodes::Wanted& wanted, Room& room);

    /// Adds the next frame.
    void add(const episodes::Recording& recording);
    /// Returns the episode at its end; null where it did not fit.
    std::shared_ptr<const Kept> take();

private:
    /// Makes room for the next frames; `length`: frames of the episode, or 0 where unknown. Returns
    /// false where there is no room.
    bool make_places(std::uint64_t length);
    void forget();

    const episodes::Wanted& wanted_;
    Room& room_;
    std::size_t bytes_ = 0;     ///< bytes of a frame
    std::uint64_t places_ = 0;  ///< frames that fit into the room taken
    std::shared_ptr<Kept> kept_;
};

/// Replays the frames of a kept episode.
class KeptFrames final : public episodes::Frames {
public:
    /// `wanted`: what was kept; outlives this.
    KeptFrames(const episodes::Wanted& wanted, std::shared_ptr<const Kept> kept);

    diag::Result<bool> next() override;
    const std::vector<plan::Sample>& samples() const override { return samples_; }
    episodes::Label label(Index predicate) const override;
    std::uint64_t frames() const override { return frames_; }

private:
    const episodes::Wanted& wanted_;
    std::shared_ptr<const Kept> kept_;
    std::vector<std::size_t> places_;  ///< per predicate of the model, its index among those wanted
    std::vector<plan::Sample> samples_;
    std::size_t at_ = 0;  ///< index of the next frame's values
    std::uint64_t frames_ = 0;
};

class Readings {
public:
    /// Returns nothing after an error.
    static std::optional<Readings> read(episodes::Wanted wanted, const Request& request,
                                        diag::Sink& sink);

    /// Returns the episodes in the order of episodes/folds.hpp.
    const std::vector<episodes::Recorded>& episodes() const { return episodes_; }
    /// Returns their paths.
    std::vector<std::string> paths() const;
    const check::Labelling& labelling() const { return labelling_; }
    std::size_t index_of(const std::string& path) const { return index_.at(path); }
    const episodes::Wanted& wanted() const { return *wanted_; }

    /// Opens an episode at its first frame. Thread-safe. Failures do not name the episode.
    diag::Result<std::unique_ptr<episodes::Frames>> open(std::size_t episode) const;

private:
    std::unique_ptr<const episodes::Wanted> wanted_;
    episodes::ReadOptions reading_;
    std::vector<episodes::Recorded> episodes_;
    std::vector<std::shared_ptr<const Kept>> kept_;  ///< per episode; null: read again
    std::unordered_map<std::string, std::size_t> index_;
    check::Labelling labelling_;
};

}  // namespace etlc::fit
