// Values of predicates and bools on a trace. Inputs, targets and literals are float32, everything
// computed from them is double; what is missing, invalid or has no value is unknown, never a
// number.
#pragma once

#include <optional>
#include <vector>

#include "check/model/model.hpp"
#include "reference/reference.hpp"

namespace etlc::reference {

/// Per input, its sample as the monitor gets it; empty where missing after `hold`.
using Samples = std::vector<std::vector<float>>;

/// Returns the samples of every step: narrowed to float32, without invalid and stale ones, with
/// `hold` applied.
std::vector<Samples> accept(const check::Model& model, const Trace& trace);

/// The delta of a predicate at a step of the trace, nothing where unknown; the nearest row of a
/// plain distance.
struct Measurement {
    std::optional<double> delta;
    std::uint32_t nearest = 0;
};
Measurement measure(const check::Model& model, const check::Predicate& predicate,
                    const std::vector<Samples>& trace, std::size_t step);

/// Returns d aggregated over the target set, with the row of the smallest d; nothing where the
/// point is missing, or the zero vector under cosine and angular.
Measurement distance(const check::Model& model, const check::Distance& distance,
                     const std::vector<Samples>& trace, std::size_t step);

}  // namespace etlc::reference
