// What fitting takes of the episodes: per fold the moments of points, and some of their frames.
// Takes: a model, and episodes in order. Gives: for every fitted thing what its method needs.
// Keeps true: all of it is read in one pass; an episode is in one fold; the number of threads and
// the order in which episodes finish do not count.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "check/model/model.hpp"
#include "data/traces/trace.hpp"
#include "diag/diag.hpp"
#include "episodes/recording.hpp"
#include "fit/algebra/moments.hpp"
#include "fit/even_frames.hpp"
#include "fit/request.hpp"

namespace etlc::fit {

using check::Index;

/// Episodes are dealt to so many folds, one after the other.
inline constexpr std::size_t kFolds = 5;

/// Frames of a target set are taken from so many of all episodes, or one of each.
inline constexpr std::size_t kMostFrames = 2048;

/// Something to collect of the frames at which a formula holds.
struct Need {
    enum class Kind : std::uint8_t {
        mean,
        scatter,  ///< with the mean
        classes,  ///< means of the frames at which it holds and of the others, and their scatter
        frames,
    };
    Kind kind = Kind::mean;
    Index point = 0;             ///< of Model::points, without projections
    Index where = check::kNone;  ///< of Model::formulas; kNone: true
    Index label = check::kNone;  ///< in place of `where`: a predicate, whose truth it is
    std::uint32_t away = 0;      ///< frames

    bool operator==(const Need&) const = default;
};

/// What an episode or a fold has of a need.
struct Counts {
    std::uint64_t holds = 0;
    std::uint64_t others = 0;
    std::uint64_t unknown = 0;   ///< frames at which a missing sample leaves open whether it holds
    std::uint64_t missing = 0;   ///< frames whose point is missing or not finite
    std::uint64_t episodes = 0;  ///< in which it holds at some frame with a point

    std::uint64_t frames() const { return holds + others + unknown + missing; }
    void add(const Counts& other);
};

/// A frame that was taken, and where it is from.
struct Source {
    std::size_t episode = 0;
    TakenFrame frame;
};

struct Collected {
    Moments moments;
    std::vector<Source> frames;
    Counts counts;
};

/// What was read of all episodes.
struct Collection {
    std::vector<episodes::Recorded> episodes;   ///< in order
    std::vector<Index> from_arrays;             ///< predicates labelled by arrays in all
    std::vector<std::vector<Collected>> folds;  ///< by fold, then by need

    std::size_t fold_of(std::size_t episode) const { return episode % folds.size(); }
};

/// Nothing where the sink now says why.
std::optional<Collection> collect(const check::Model& model, const std::vector<Need>& needs,
                                  const std::vector<std::string>& paths, const Request& request,
                                  diag::Sink& sink);

/// The samples of a point without projections; false where one is missing or not finite.
bool read_point(const check::Model& model, Index point, const std::vector<plan::Sample>& samples,
                std::vector<float>& values);

/// The point without its projections.
Index innermost(const check::Model& model, Index point);

}  // namespace etlc::fit
