// drift: whether new episodes still look like those of calibration. The class bets on the cells of
// the scores of calibration (etlmon/temporal/drift.hpp).
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "artifacts/thresholds.hpp"
#include "check/context/context.hpp"

namespace etlc::check {

/// A score of calibration, with a random number that decides between equal scores.
using Drawn = std::pair<float, std::uint32_t>;

/// Returns the scores, ascending. The random numbers come from a hash of all scores, so that the
/// same file gives the same class.
std::vector<Drawn> draw(const std::vector<float>& scores);

/// Merges the gaps between at least 7 ascending scores into cells. A greater score is less usual.
etlmon::DriftCells drift_cells(const std::vector<Drawn>& scores, double level);

/// Sets the cells from the scores in the file, or reports why there are none.
void take_drift(Context& context, Drift& drift, const thresholds::File& file);

}  // namespace etlc::check
