// `etlc calibrate`: computes thresholds from labelled demonstrations, and reports on them. The
// result does not depend on the number of threads, and each thread has one episode open at a time.
// Whatever voids the guarantee is refused: too few demonstrations, repeated ones, targets among
// their frames.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "artifacts/fitted.hpp"
#include "artifacts/thresholds.hpp"
#include "calibrate/fit.hpp"
#include "calibrate/other_error.hpp"
#include "calibrate/scores.hpp"
#include "check/model/model.hpp"
#include "diag/diag.hpp"
#include "episodes/shared/sharing.hpp"

namespace etlc::calibrate {

struct Request {
    std::vector<std::string> episodes;  ///< as recordings::find_episodes gives them
    episodes::ReadOptions reading;
    std::string allow_overlap;  ///< reason to allow overlaps; empty: refuse them
    fitted::File fitted;        ///< the model's fitted entries, whose episodes are refused
    unsigned jobs = 0;          ///< threads; 0: as many as the machine has
    std::uint32_t folds = 0;    ///< to report on thresholds without each fold; 0: none
    std::string version;        ///< of etlc
    /// Called occasionally, by any thread, never by two at once.
    std::function<void(std::size_t done, std::size_t total)> progress;
    /// One shard of the episodes, or all shards; null: this process reads all episodes.
    episodes::Sharing* sharing = nullptr;
};

/// Scores the demonstrations, and passes each to `take`, in order. Returns false after an error,
/// which it reports, and for a shard.
bool score_demonstrations(const check::Model& model, const std::vector<Index>& predicates,
                          const Watched& watched, const Request& request,
                          const std::function<void(const Demonstration&)>& take, diag::Sink& sink);

struct Calibration {
    thresholds::File file;
    std::string report;
};

/// Calibrates the predicates. Returns nothing after an error, which it reports.
std::optional<Calibration> calibrate(const check::Model& model, const Request& request,
                                     diag::Sink& sink);

/// The errors that the guarantees do not bound.
struct Others {
    std::vector<Guaranteed> guarantees;
    std::vector<OtherError> by_predicate;
    std::vector<OtherError> by_guarantee;
};

/// Returns " in 4 groups", or nothing where no episode has a group.
std::string in_groups(const episodes::Groups& groups);

/// Describes the thresholds, their scores, their guarantees and the other errors. `model` already
/// has the thresholds.
std::string report(const check::Model& model, const std::vector<Index>& predicates,
                   const std::vector<Evidence>& evidence, const episodes::Groups& groups,
                   std::uint64_t frames, const std::vector<Sides>& fitted, const Others& others);

/// Describes how many episodes were left out since they are no demonstrations; empty for none.
std::string describe_failures(std::uint64_t failures);

/// Describes the losses of thresholds by risk, and those that are infinite, in lines.
std::string describe_sides(const Subject& of, const Sides& sides);

/// Reports the thresholds without each fold, and their results on it; empty for 0 folds. They show
/// how much the thresholds depend on single recordings, and guarantee nothing.
std::string report_of_folds(const std::vector<Subject>& subjects,
                            const episodes::Identities& episodes, const episodes::Groups& groups,
                            std::uint32_t folds);

/// Fits the thresholds of a predicate, or of a monitor as one. Returns nothing after an error,
/// which it reports.
std::optional<Sides> fit_all(const check::Model& model, const Subject& of, diag::Sink& sink);

}  // namespace etlc::calibrate
