// Collects what fitting needs of the episodes in one pass: per fold the moments of points, and some
// of their frames. Only the content of the episodes decides the result, not their names, their
// order or the number of threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "check/guarantees/provenance.hpp"
#include "check/model/model.hpp"
#include "diag/diag.hpp"
#include "episodes/recording.hpp"
#include "fit/algebra/moments.hpp"
#include "recordings/open.hpp"

namespace etlc::fit {

// Takes up to `most` frames of an episode, evenly spaced and away from changes of the label. The
// choice depends on this episode alone, and memory on `most` and `away`. The ends of an episode are
// no changes: the label before and after is unknown.

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

// Reads the episodes of a call once, in the order of their content, and gives their frames again
// for later passes. Neither names of files nor the order of arguments count.

/// The arguments of `etlc fit`.
struct Request {
    std::vector<std::string> episodes;  ///< as recordings::find_episodes gives them
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
    /// The most bytes of samples to keep in memory, unless `reading` keeps them.
    std::size_t cache_bytes = episodes::kCacheBytes;
};

using check::Index;

class Recordings {
public:
    /// Leaves out episodes without a label that is wanted, unless all are. Returns nothing after an
    /// error.
    static std::optional<Recordings> read(episodes::Wanted wanted, const Request& request,
                                          diag::Sink& sink);

    /// Returns the episodes in the order of episodes/folds.hpp.
    const std::vector<episodes::Recorded>& episodes() const { return episodes_; }
    /// Returns their paths.
    std::vector<std::string> paths() const;
    /// Returns the paths of those that were left out.
    const std::vector<std::string>& unlabelled() const { return unlabelled_; }
    const check::Labelling& labelling() const { return labelling_; }
    std::size_t index_of(const std::string& path) const { return index_.at(path); }
    const episodes::Wanted& wanted() const { return *wanted_; }

    /// Opens an episode at its first frame. Thread-safe. Failures do not name the episode.
    diag::Result<episodes::Recording> open(std::size_t episode) const;

private:
    std::unique_ptr<const episodes::Wanted> wanted_;
    episodes::ReadOptions reading_;
    std::vector<episodes::Recorded> episodes_;
    std::vector<std::string> unlabelled_;
    std::unordered_map<std::string, std::size_t> index_;
    check::Labelling labelling_;
};

/// The number of folds, to which episodes/folds.hpp deals the episodes.
inline constexpr std::size_t kFolds = 5;

/// The most frames to choose a target set from, over all episodes; at least one of each.
inline constexpr std::size_t kMostFrames = 2048;

/// Collected at the frames at which a formula holds.
struct Need {
    enum class Kind : std::uint8_t {
        mean,
        scatter,  ///< mean and scatter
        classes,  ///< means where it holds and where it does not, and their scatter
        frames,
    };
    Kind kind = Kind::mean;
    Index point = 0;             ///< of Model::points, without projections
    Index where = check::kNone;  ///< of Model::formulas; kNone: true
    Index label = check::kNone;  ///< in place of `where`: a predicate whose labels count
    std::uint32_t away = 0;      ///< frames to keep away from changes of the label

    bool operator==(const Need&) const = default;
};

/// The frames that an episode or a fold has for a need.
struct Counts {
    std::uint64_t holds = 0;
    std::uint64_t others = 0;
    std::uint64_t unknown = 0;   ///< a missing sample leaves open whether `where` holds
    std::uint64_t missing = 0;   ///< frames whose point is missing or not finite
    std::uint64_t episodes = 0;  ///< with a frame at which `where` holds and the point is present

    std::uint64_t frames() const { return holds + others + unknown + missing; }
    void add(const Counts& other);
};

/// A frame that was taken, with its origin.
struct Source {
    std::size_t episode = 0;
    TakenFrame frame;
};

struct Collected {
    Moments moments;
    std::vector<Source> frames;
    Counts counts;
};

/// Everything collected from all episodes.
struct Collection {
    Recordings recordings;
    std::vector<std::vector<Collected>> folds;  ///< by fold, then by need
    std::vector<std::uint32_t> dealt;           ///< per episode, its fold

    std::size_t fold_of(std::size_t episode) const { return dealt[episode]; }
};

/// A predicate to measure, and the predicate whose labels it is scored against.
struct Measured {
    Index predicate = 0;
    Index label = 0;
};

/// `measured`: the predicates that will be measured in a second pass. Returns nothing after an
/// error.
std::optional<Collection> collect(const check::Model& model, const std::vector<Need>& needs,
                                  const std::vector<Measured>& measured, const Request& request,
                                  diag::Sink& sink);

/// Returns the innermost point, without projections.
Index innermost(const check::Model& model, Index point);

// Collects frames in blocks and turns them into moments. Frames that several needs share are
// scattered once; memory is that of a block.

class Blocks {
public:
    /// The class of a frame that counts in none.
    static constexpr std::int8_t kNone = -1;

    /// `with_scatter`: per need.
    Blocks(Eigen::Index dimension, std::vector<bool> with_scatter);

    /// `classes`: per need.
    void add(const std::vector<float>& point, const std::vector<std::int8_t>& classes);
    /// Returns the moments of all frames since the last call, per need.
    std::vector<Moments> take();

private:
    void flush();
    std::shared_ptr<Scatter> scatter(const std::vector<bool>& selected);
    std::shared_ptr<Scatter> unused_scatter();
    Mean mean(std::size_t need, std::size_t of_class) const;

    static constexpr Eigen::Index kFrames = 512;

    Eigen::MatrixXf frames_;  ///< frames, as columns
    Eigen::Index filled_ = 0;
    std::vector<bool> with_scatter_;
    std::vector<std::vector<std::int8_t>> classes_;  ///< per need, then per frame of the block
    std::vector<Moments> moments_;
    // These are large, so they are allocated once.
    Matrix selected_;                                 ///< frames
    std::vector<std::shared_ptr<Scatter>> scatters_;  ///< may be in use by moments
};

}  // namespace etlc::fit
