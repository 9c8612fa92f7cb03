// A test case of a campaign: one random formula, and random traces for it.
// Takes: the seed of the campaign and a number. Gives: the same case every time. Keeps true: depths
// 1 to 5, prefix and sliding monitors, windows to 40 and short ones, robustness and truth values
// alternate; traces reach 200 steps, with gaps and invalid samples.
#pragma once

#include <cstdint>
#include <string>

#include "check/model/model.hpp"
#include "random_spec.hpp"
#include "reference/reference.hpp"

namespace etlc::tests {

inline constexpr int kDepths = 5;
inline constexpr int kLongWindow = 40;
inline constexpr int kShortWindow = 6;
/// The fraction of future operators: half, or nearly all.
inline constexpr double kMostlyFuture = 0.8;

struct Subject {
    std::uint64_t seed = 0;
    SpecShape shape;
    check::Values values = check::Values::robustness;
    bool sliding() const { return shape.formulas == SpecShape::Formulas::sliding; }
    std::string spec() const { return random_spec(seed, shape); }
};

/// Makes subject n of a campaign, with `monitors` formulas in its spec.
Subject subject(std::uint64_t campaign, std::uint64_t n, int monitors);

/// Makes trace t of a subject: in turn complete, with gaps, and also with invalid samples.
reference::Trace subject_trace(const check::Model& model, const Subject& subject, int t,
                               std::size_t longest = 200);

/// Copies the trace up to a step of it and adds other samples, many at the ends of their ranges: a
/// continuation of that prefix.
reference::Trace continuation(const check::Model& model, const reference::Trace& trace,
                              std::uint64_t seed);

}  // namespace etlc::tests
