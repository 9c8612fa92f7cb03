// What any build of the monitor may measure where this one measured delta.
// Takes: a predicate as the plan's evaluator has just measured it. Gives: the interval in which its
// delta lies on every compiler and CPU, under any of the flags that the runtime allows, flush to
// zero included. Keeps true: the interval depends on the sample alone, not on the machine beyond
// the kernels' rounding (etlmon/hosted/error_bounds.hpp); scalars and arithmetic on them are
// exact, because every build rounds them alike (etlmon/temporal/expression.hpp).
#pragma once

#include <optional>

#include "check/model/model.hpp"
#include "plan/evaluate/evaluator.hpp"

namespace etlc::calibrate {

using check::Index;

struct Interval {
    double low = 0;
    double high = 0;
};

/// The interval of a distance of D dimensions, aggregated over `rows` targets, where ours measured
/// `delta`. Not of mahalanobis with full weights, whose error depends on the point.
Interval interval_of(const check::Distance& distance, std::uint32_t rows, std::uint32_t dimension,
                     double delta);

/// The interval of the predicate's delta; its ends are infinite where delta is, or may be. Nothing
/// where it is unknown.
std::optional<Interval> interval_of(const check::Model& model, Index predicate,
                                    const plan::Evaluator& measured);

}  // namespace etlc::calibrate
