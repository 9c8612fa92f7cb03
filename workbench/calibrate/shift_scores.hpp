// Monitors beside their ground truth, an episode at a time.
// Takes: both plans and an episode. Gives: the score of every calibrated monitor. Keeps true: rho
// is taken as pessimistic as a verdict takes it where samples are missing; otherwise as high (low)
// as any build may measure.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "calibrate/shift.hpp"
#include "episodes/replay.hpp"

namespace etlc::calibrate {

/// Not shared between threads; all that it is given outlives it.
class MonitorScorer {
public:
    MonitorScorer(const check::Model& model, const MonitorPlans& plans,
                  const episodes::Leaks& leaks, const std::vector<Index>& monitors,
                  const data::NamesInFile& names);
    MonitorScorer(const MonitorScorer&) = delete;
    MonitorScorer& operator=(const MonitorScorer&) = delete;

    /// Failures do not name the path.
    diag::Result<MonitorEpisode> score(const std::string& path);

private:
    void note(std::vector<MonitorScore>& scores) const;

    const check::Model& model_;
    const std::vector<Index>& monitors_;
    const data::NamesInFile& names_;
    episodes::Follower highest_;  ///< rho as high as any build may have it
    episodes::Follower lowest_;
    episodes::Follower truths_;
    episodes::Wanted wanted_;
};

}  // namespace etlc::calibrate
