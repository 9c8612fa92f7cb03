// Calibration of whole monitors: the shift of rho of each calibrated monitor, from labelled
// episodes on which the thresholds of its predicates were not calibrated. The score of an episode
// is the greatest low end of rho, in any build, over the steps at which the ground-truth monitor is
// violated (against missed_success: the least high end over those at which it is satisfied). These
// are the ends that a verdict is decided by. With `normal` it is the least upper bound over all
// steps, by which the monitor is violated for good. The shift is strictly beyond score k, so no
// such step of a covered episode has the wrong sign. A step without such an end, because of a
// missing sample, cannot have it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calibrate/calibrate.hpp"
#include "episodes/recording.hpp"

namespace etlc::calibrate {

/// Returns the monitors that are calibrated: as a whole, or with a duration.
std::vector<Index> calibrated_monitors(const check::Model& model);

/// Returns the model without shifts, from which its plan is made.
check::Model unshifted(check::Model model);

struct MonitorEpisode : episodes::Recorded {
    std::vector<Scores> scores;      ///< per monitor that is calibrated as a whole
    std::vector<double> durations;   ///< per monitor with a calibrated duration: DurationScorer
    std::vector<Index> from_arrays;  ///< predicates with an array of labels
    std::string track;               ///< of what the monitors see
    bool is_divided = true;          ///< it has all labels that divide it into phases
};

template <class Archive>
void fields(Archive& archive, MonitorEpisode& episode) {
    archive(static_cast<episodes::Recorded&>(episode), episode.scores, episode.durations,
            episode.from_arrays, episode.track, episode.is_divided);
}

/// Adds the shifts and durations of the calibrated monitors to `before`, the file with the
/// thresholds of the predicates, which is empty if all are literal. Labels are read for the
/// predicates in these monitors that are not their own truth, and for those with an array of labels
/// in the first episode. Returns nothing after an error, which it reports.
std::optional<Calibration> calibrate_monitors(const check::Model& model, thresholds::File before,
                                              const Request& request, diag::Sink& sink);

}  // namespace etlc::calibrate
