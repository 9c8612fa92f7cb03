// Monitors beside their ground truth, an episode at a time.
// Takes: both plans and an episode. Gives: the score of every calibrated monitor. Keeps true: rho
// is taken as pessimistic as a verdict takes it where samples are missing; otherwise as high (low)
// as any build may measure.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "calibrate/episodes/recording.hpp"
#include "calibrate/shift.hpp"

namespace etlc::calibrate {

/// Not shared between threads; all that it is given outlives it.
class MonitorScorer {
public:
    MonitorScorer(const check::Model& model, const MonitorPlans& plans, const Leaks& leaks,
                  const std::vector<Index>& monitors, const data::NamesInFile& names);
    MonitorScorer(const MonitorScorer&) = delete;
    MonitorScorer& operator=(const MonitorScorer&) = delete;

    /// Failures do not name the path.
    diag::Result<MonitorEpisode> score(const std::string& path);

private:
    void note(const std::vector<etlmon::Verdict>& truths,
              const std::vector<etlmon::Verdict>& highest,
              const std::vector<etlmon::Verdict>& lowest, MonitorEpisode& episode) const;

    const check::Model& model_;
    const MonitorPlans& plans_;
    const Leaks& leaks_;
    const std::vector<Index>& monitors_;
    const data::NamesInFile& names_;
    std::vector<std::size_t> said_at_;   ///< per calibrated monitor, its index in plans_.monitors
    std::vector<std::size_t> truth_at_;  ///< and in plans_.truths
    plan::Evaluator highest_;            ///< rho as high as any build may have it
    plan::Evaluator lowest_;
    plan::Evaluator truths_;
    Wanted wanted_;
};

}  // namespace etlc::calibrate
