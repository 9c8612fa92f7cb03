// The interval in which a predicate's delta lies on every compiler and CPU, under all flags that
// the runtime allows, flush to zero included. It depends on the sample and on the kernels' rounding
// (etlmon/hosted/error_bounds.hpp). Scalars and arithmetic on them are exact, because every build
// rounds them alike (etlmon/temporal/expression.hpp).
#pragma once

#include <optional>
#include <vector>

#include "check/model/model.hpp"
#include "execute/evaluator.hpp"

namespace etlc::calibrate {

using check::Index;

struct Interval {
    double low = 0;
    double high = 0;
};

/// The intervals of the numbers that earlier steps have a part in, from those of what they are
/// computed from. Every build computes them from its own values without rounding, or with the
/// rounding of a mean, and they grow with each value.
class PastIntervals {
public:
    explicit PastIntervals(const check::Model& model, const plan::Plan& plan);

    void reset();
    /// Takes the step that the evaluator has measured.
    void step(const execute::Evaluator& measured);
    /// Returns the interval at the last step of a number that this build knows.
    const check::Range& operator[](Index past) const { return now_[past]; }

private:
    const check::Model& model_;
    const std::vector<Index>& pasts_;
    std::vector<execute::PastState> lows_;   ///< as pasts_
    std::vector<execute::PastState> highs_;  ///< likewise
    std::vector<check::Range> now_;          ///< per past number of the model
};

/// Returns the interval of a distance, aggregated over `rows` targets, that this build measured as
/// `delta`. Not for mahalanobis with full weights, whose error depends on the point.
Interval interval_of(const check::Distance& distance, std::uint32_t rows, std::uint32_t dimension,
                     double delta);

/// Returns the interval of the delta just measured, or nothing if it is unknown. An end is infinite
/// where delta is or may be.
std::optional<Interval> interval_of(const check::Model& model, Index predicate,
                                    const execute::Evaluator& measured, const PastIntervals& pasts);

}  // namespace etlc::calibrate
