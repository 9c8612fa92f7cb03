// From a trace to the values of predicates and bools.
// Takes: the spec and the samples as recorded. Gives: per step every predicate's delta and
// robustness, and every bool. Keeps true: inputs, targets and literals are float32, everything
// computed from them is double; what is missing, invalid or has no value is unknown, never a
// number.
#pragma once

#include <optional>
#include <vector>

#include "check/model/model.hpp"
#include "reference/reference.hpp"

namespace etlc::reference {

/// Per input, its sample as the monitor takes it; empty where it is missing after `hold`.
using Samples = std::vector<std::vector<float>>;

/// Samples of every step: narrowed to float32, invalid ones dropped, held ones filled in.
std::vector<Samples> accept(const check::Model& model, const Trace& trace);

/// delta of a predicate, nothing where it is unknown; the nearest row where it is a plain distance.
struct Measurement {
    std::optional<double> delta;
    std::uint32_t nearest = 0;
};
Measurement measure(const check::Model& model, const check::Predicate& predicate,
                    const Samples& samples);

/// d aggregated over the target set, with the row of the smallest d; nothing where the point is
/// missing, or the zero vector under cosine and angular.
Measurement distance(const check::Model& model, const check::Distance& distance,
                     const Samples& samples);

}  // namespace etlc::reference
