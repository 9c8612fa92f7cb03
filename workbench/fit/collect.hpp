// What fitting takes of the episodes: per fold the moments of points, and some of their frames.
// Takes: a model, and episodes. Gives: for every fitted thing what its method needs. Keeps true:
// all of it is collected in one pass; an episode is in one fold; the content of the episodes alone
// counts, neither their names nor their order, nor the number of threads.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "check/model/model.hpp"
#include "data/recordings/open.hpp"
#include "diag/diag.hpp"
#include "fit/algebra/moments.hpp"
#include "fit/even_frames.hpp"
#include "fit/readings.hpp"

namespace etlc::fit {

/// Episodes are dealt to so many folds by their content, as episodes/folds.hpp deals them.
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
    Readings readings;
    std::vector<std::vector<Collected>> folds;  ///< by fold, then by need

    std::size_t fold_of(std::size_t episode) const { return episode % folds.size(); }
};

/// A predicate whose distance is measured, and the one whose labels it is to tell apart.
struct Measured {
    Index predicate = 0;
    Index label = 0;
};

/// `measured`: for whom the episodes are gone through again. Nothing where the sink now says why.
std::optional<Collection> collect(const check::Model& model, const std::vector<Need>& needs,
                                  const std::vector<Measured>& measured, const Request& request,
                                  diag::Sink& sink);

/// The samples of a point without projections; false where one is missing or not finite.
bool read_point(const check::Model& model, Index point, const std::vector<plan::Sample>& samples,
                std::vector<float>& values);

/// The point without its projections.
Index innermost(const check::Model& model, Index point);

}  // namespace etlc::fit
