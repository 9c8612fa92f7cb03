// Collects what fitting needs of the episodes in one pass: per fold the moments of points, and some
// of their frames. Only the content of the episodes decides the result, not their names, their
// order or the number of threads.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "check/model/model.hpp"
#include "diag/diag.hpp"
#include "fit/algebra/moments.hpp"
#include "fit/even_frames.hpp"
#include "fit/readings.hpp"
#include "recordings/open.hpp"

namespace etlc::fit {

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
    Readings readings;
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

}  // namespace etlc::fit
