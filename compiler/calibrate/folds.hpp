// What thresholds would be without some of the demonstrations, and how they do on these.
// Takes: the scores of all demonstrations, and a number of folds. Gives: lines of the report. Keeps
// true: folds are those of every command (episodes/folds.hpp); what is said of a fold comes from
// thresholds that have not seen it. It says how far the thresholds hang on single recordings, and
// guarantees nothing.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "calibrate/shift.hpp"

namespace etlc::calibrate {

std::string report_of_folds(const check::Model& model, const std::vector<Index>& predicates,
                            const std::vector<Demonstration>& demonstrations, std::uint32_t folds);

/// The same of monitors that are calibrated as a whole.
std::string report_of_folds(const check::Model& model, const std::vector<Index>& monitors,
                            const std::vector<MonitorEpisode>& episodes, std::uint32_t folds);

}  // namespace etlc::calibrate
