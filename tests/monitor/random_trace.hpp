// Random traces for a spec, and traces as CSV.
// Takes: the typed spec and a seed. Gives: samples with gaps. Keeps true: the same seed gives the
// same trace; what an embedding of f16 or i8 holds can be represented in that type.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "check/model/model.hpp"
#include "reference/reference.hpp"

namespace etlc::tests {

struct TraceShape {
    std::size_t steps = 12;
    double missing = 0;  ///< probability that a sample is not there
    /// Probability of NaN, an infinity, a value out of range or a zero vector instead.
    double invalid = 0;
    /// Probability of a sample at an end of its range, or far out where it has none.
    double extreme = 0;
    /// Multiples of 1/4 in [-4, 4], so that ties and exact zeros occur; else any float32 there.
    bool grid = true;
};

reference::Trace random_trace(const check::Model& model, std::uint64_t seed,
                              const TraceShape& shape);

/// As `etlc run` reads it: with a header, an empty cell is a missing sample, i8 embeddings hold
/// integers.
std::string to_csv(const check::Model& model, const reference::Trace& trace);

/// A trace of that form. Fails the current test where the file cannot be read.
reference::Trace read_csv(const check::Model& model, const std::string& path);

}  // namespace etlc::tests
