// The thresholds that all episodes but one give, for each episode, by the rule of the whole
// calibration. At most two scores can be at the rank of a conformal threshold when one of them is
// left out, so few thresholds are computed however many episodes there are.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "calibrate/fit.hpp"
#include "episodes/recording.hpp"

namespace etlc::calibrate {

/// More episodes than this are left out of an f1 threshold in as many groups: its best score is no
/// order statistic.
inline constexpr std::uint32_t kMostGroups = 64;

struct LeftOut {
    std::vector<float> thresholds;  ///< per episode; empty if one of them is missing
    std::string why;                ///< why one is missing: "no finite threshold is left"
    std::uint32_t groups = 0;       ///< f1: number of groups, if fewer than episodes
};

/// Returns the thresholds of a predicate without each demonstration.
LeftOut left_out(const check::Predicate& predicate, const Evidence& evidence,
                 const episodes::Identities& demonstrations);

/// Returns the shifts of a monitor that is calibrated as a whole without each episode. `worst`: the
/// score of each episode that has one.
LeftOut left_out(const check::MonitorCalibration& calibration,
                 const std::vector<Evidence::Reach>& worst, std::size_t episodes);

}  // namespace etlc::calibrate
