// The interval in which a predicate's delta lies on every compiler and CPU, under all flags that
// the runtime allows, flush to zero included. It depends on the sample and on the kernels' rounding
// (etlmon/hosted/error_bounds.hpp). Scalars and arithmetic on them are exact, because every build
// rounds them alike (etlmon/temporal/expression.hpp).
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

/// Returns the interval of a distance, aggregated over `rows` targets, that this build measured as
/// `delta`. Not for mahalanobis with full weights, whose error depends on the point.
Interval interval_of(const check::Distance& distance, std::uint32_t rows, std::uint32_t dimension,
                     double delta);

/// Returns the interval of the delta just measured, or nothing if it is unknown. An end is infinite
/// where delta is or may be.
std::optional<Interval> interval_of(const check::Model& model, Index predicate,
                                    const plan::Evaluator& measured);

}  // namespace etlc::calibrate
