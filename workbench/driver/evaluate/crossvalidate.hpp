// The whole chain from labelled episodes to monitors, once for every fold of them.
// Takes: a spec that lacks thresholds, and the episodes. Gives: per fold the compiled spec that the
// other folds give. Keeps true: nothing of a monitor was taken from an episode of its fold; stages
// that may not share episodes get disjoint ones.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "artifacts/fitted.hpp"
#include "artifacts/thresholds.hpp"
#include "calibrate/calibrate.hpp"
#include "diag/diag.hpp"
#include "driver/compile/compile.hpp"

namespace etlc::driver {

struct Folds {
    std::uint32_t count = 0;
    std::vector<std::uint32_t> of;    ///< per episode its fold, from 0 on
    std::vector<std::size_t> order;   ///< of the episodes, by their content
    thresholds::Allowance allowance;  ///< overlaps between episodes that were passed over
};

/// What the folds other than one give.
struct Trained {
    pipeline::Compiled spec;
    fitted::File fitted;
    thresholds::File thresholds;
};

/// Deals the episodes of the request, which are no copies of each other. Nothing where the sink now
/// says why.
std::optional<Folds> deal(const check::Model& model, const calibrate::Request& request,
                          std::uint32_t folds, diag::Sink& sink);

/// In the order of the folds. Nothing where the sink now says why, and in which fold.
std::optional<std::vector<Trained>> train(const source::File& file, const Request& request,
                                          const calibrate::Request& calibration, const Folds& folds,
                                          diag::Sink& sink);

}  // namespace etlc::driver
