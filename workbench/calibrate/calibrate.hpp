// `etlc calibrate`: thresholds from labelled demonstrations.
// Takes: a spec that may lack thresholds, and the episodes. Gives: the thresholds file and what a
// person should know about it. Keeps true: the result is the same whatever the number of threads;
// one episode a thread is open at a time; what voids the guarantee (too few demonstrations, one
// that is given twice, one that is its own target) is refused.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "calibrate/fit.hpp"
#include "calibrate/scores.hpp"
#include "check/model/model.hpp"
#include "diag/diag.hpp"
#include "episodes/shared/sharing.hpp"
#include "fitted/fitted.hpp"
#include "thresholds/thresholds.hpp"

namespace etlc::calibrate {

struct Request {
    std::vector<std::string> episodes;  ///< as data::find_episodes gives them
    data::NamesInFile names;
    /// The reason for which overlaps are passed over; empty: they are not.
    std::string allow_overlap;
    fitted::File fitted;      ///< what is fitted in the model: its episodes are refused
    unsigned jobs = 0;        ///< threads; 0: as many as the machine has
    std::uint32_t folds = 0;  ///< without each of which thresholds are taken too; 0: none
    std::string version;      ///< of etlc
    /// Called now and then, by any thread, never by two at once.
    std::function<void(std::size_t done, std::size_t total)> progress;
    /// One shard of the episodes, or all of them; null: this process reads them all.
    episodes::Sharing* sharing = nullptr;
};

struct Calibration {
    thresholds::File file;
    std::string report;
};

/// Nothing where the sink now says why.
std::optional<Calibration> calibrate(const check::Model& model, const Request& request,
                                     diag::Sink& sink);

/// What the thresholds are, what they were taken from, and what they guarantee. `model` has them
/// already.
std::string report(const check::Model& model, const std::vector<Index>& predicates,
                   const std::vector<Evidence>& evidence, std::uint64_t frames,
                   const std::vector<Fitted>& fitted);

}  // namespace etlc::calibrate
