// Calibration of whole monitors: by how much rho has to be shifted.
// Takes: a spec whose predicates have their thresholds, and labelled episodes that these were not
// calibrated on. Gives: per calibrated monitor a shift. Keeps true: the score of an episode is the
// greatest rho over the steps at which the ground-truth monitor is violated (against
// missed_success: the least over those at which it is satisfied), in every build; the shift is
// strictly beyond score k, so a covered episode has no such step with the wrong sign.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calibrate/calibrate.hpp"
#include "episodes/recording.hpp"
#include "episodes/truth.hpp"
#include "plan/plan.hpp"

namespace etlc::calibrate {

/// Monitors of the model that are calibrated as a whole.
std::vector<Index> calibrated_monitors(const check::Model& model);

/// The model without shifts: what its plan is made of.
check::Model unshifted(check::Model model);

/// Plans of the unshifted model and of its ground truth.
struct MonitorPlans {
    const plan::Plan& monitors;
    const plan::Plan& truths;
    const episodes::GroundTruth& ground_truth;
};

/// One monitor in one episode. Scores are negated for missed_success, so that a smaller one always
/// is a better one.
struct MonitorScore {
    std::uint64_t steps = 0;    ///< at which the truth is what the monitor must not miss
    std::uint64_t unknown = 0;  ///< at which a missing sample leaves that open
    double worst = 0;           ///< where steps > 0: the worst rho over them in any build
};

using MonitorScores = std::vector<MonitorScore>;  ///< per calibrated monitor

struct MonitorEpisode : episodes::Recorded {
    MonitorScores scores;
    std::vector<Index> from_arrays;  ///< predicates whose labels are those of an array of its
};

template <class Archive>
void fields(Archive& archive, MonitorScore& score) {
    archive(score.steps, score.unknown, score.worst);
}

template <class Archive>
void fields(Archive& archive, MonitorEpisode& episode) {
    archive(static_cast<episodes::Recorded&>(episode), episode.scores, episode.from_arrays);
}

/// Shifts for the calibrated monitors, added to `before`, the file that has the thresholds of the
/// predicates (or an empty one where all are literal). Labels are asked for of the predicates in
/// these monitors that are not their own truth, or that the first episode has an array of labels
/// for. Nothing where the sink now says why.
std::optional<Calibration> calibrate_monitors(const check::Model& model, thresholds::File before,
                                              const Request& request, diag::Sink& sink);

}  // namespace etlc::calibrate
