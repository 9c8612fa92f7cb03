// Random traces for a spec, and traces as CSV.
// Takes: the typed spec and a seed. Gives: samples with gaps. Keeps true: the same seed gives the
// same trace; inputs with `stale after` often repeat their sample; values of an f16 or i8 embedding
// are exact in that type.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "check/model/model.hpp"
#include "reference/reference.hpp"

namespace etlc::tests {

struct TraceShape {
    std::size_t steps = 12;
    double missing = 0;  ///< probability that a sample is missing
    /// Probability of NaN, an infinity, a value out of range or a zero vector instead.
    double invalid = 0;
    /// Probability of a sample at an end of its range, or far out if it has none.
    double extreme = 0;
    /// Multiples of 1/4 in [-4, 4], so that ties and exact zeros occur; otherwise any float32
    /// there.
    bool grid = true;
};

reference::Trace random_trace(const check::Model& model, std::uint64_t seed,
                              const TraceShape& shape);

/// Writes it in the format of `etlc run`: with a header, an empty cell is a missing sample, i8
/// embeddings hold integers.
std::string to_csv(const check::Model& model, const reference::Trace& trace);

/// Reads a trace of that form. Fails the current test if the file cannot be read.
reference::Trace read_csv(const check::Model& model, const std::string& path);

}  // namespace etlc::tests
