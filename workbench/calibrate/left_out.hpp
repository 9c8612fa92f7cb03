// The thresholds that all groups of episodes but one give, for each group, by the rule of the whole
// calibration; an episode without a group is one by itself. At most two scores can be at the rank
// of a conformal threshold when one of them is left out, so few thresholds are computed however
// many groups there are.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "calibrate/fit.hpp"
#include "episodes/folds.hpp"
#include "episodes/recording.hpp"

namespace etlc::calibrate {

/// More groups than this are left out of an f1 threshold in as many parts: its best score is no
/// order statistic.
inline constexpr std::uint32_t kMostParts = 64;

struct LeftOut {
    std::vector<float> thresholds;  ///< per group; empty if one of them is missing
    std::string why;                ///< why one is missing: "no finite threshold is left"
    std::uint32_t parts = 0;        ///< f1: number of parts, if fewer than groups
};

/// Returns the thresholds of a predicate without each group of demonstrations.
LeftOut left_out(const check::Predicate& predicate, const Evidence& evidence,
                 const episodes::Identities& demonstrations, const episodes::Groups& groups);

/// Returns the shifts of a monitor that is calibrated as a whole without each group. `worst`: the
/// score of each group that has one.
LeftOut left_out(const check::MonitorCalibration& calibration,
                 const std::vector<Evidence::Reach>& worst, std::size_t groups);

}  // namespace etlc::calibrate
