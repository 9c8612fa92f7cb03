// The episodes of a call, read once.
// Takes: the episodes, and what is wanted of each. Gives: them in the order of their content, and
// each to be gone through again. Keeps true: neither names of files nor the order of arguments
// count; what fits into `most_kept` bytes, all episodes together, is not read again.
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

/// What `etlc fit` is asked for.
struct Request {
    std::vector<std::string> episodes;  ///< as data::find_episodes gives them
    data::NamesInFile names;
    /// The reason for which overlaps are passed over; empty: they are not.
    std::string allow_overlap;
    unsigned jobs = 0;    ///< threads; 0: as many as the machine has
    std::string version;  ///< of etlc
    /// Called now and then, by any thread, never by two at once.
    std::function<void(std::size_t done, std::size_t total)> progress;
    /// Bytes of frames that are kept in memory, all episodes together; the others are read again.
    std::size_t most_kept = std::size_t{256} << 20U;
};

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

class Readings {
public:
    /// Nothing where the sink now says why.
    static std::optional<Readings> read(episodes::Wanted wanted, const Request& request,
                                        diag::Sink& sink);

    /// By content, as episodes/folds.hpp orders them.
    const std::vector<episodes::Recorded>& episodes() const { return episodes_; }
    /// Of the same.
    std::vector<std::string> paths() const;
    const check::Labelling& labelling() const { return labelling_; }
    std::size_t index_of(const std::string& path) const { return index_.at(path); }
    const episodes::Wanted& wanted() const { return *wanted_; }

    /// From its first frame. Any number of threads may use it at once. Failures do not name the
    /// episode.
    diag::Result<std::unique_ptr<episodes::Frames>> open(std::size_t episode) const;

private:
    std::unique_ptr<const episodes::Wanted> wanted_;
    data::NamesInFile names_;
    std::vector<episodes::Recorded> episodes_;
    std::vector<std::shared_ptr<const Kept>> kept_;  ///< per episode; null: to be read again
    std::unordered_map<std::string, std::size_t> index_;
    check::Labelling labelling_;
};

}  // namespace etlc::fit
