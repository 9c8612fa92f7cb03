// What thresholds would be without some of the demonstrations, and how they do on these.
// Takes: what demonstrations say, and the fold of each. Gives: lines of the report. Keeps
// true: folds are those of every command (episodes/folds.hpp); what is said of a fold comes from
// thresholds that have not seen it. It says how far the thresholds hang on single recordings, and
// guarantees nothing.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "calibrate/shift.hpp"

namespace etlc::calibrate {

/// Empty for 0 folds. `evidence`: per predicate.
std::string report_of_folds(const check::Model& model, const std::vector<Index>& predicates,
                            const std::vector<Evidence>& evidence,
                            const episodes::Identities& episodes, std::uint32_t folds);

/// The same of monitors that are calibrated as a whole. `scores`: per episode, of each.
std::string report_of_folds(const check::Model& model, const std::vector<Index>& monitors,
                            const std::vector<MonitorScores>& scores,
                            const episodes::Identities& episodes, std::uint32_t folds);

}  // namespace etlc::calibrate
