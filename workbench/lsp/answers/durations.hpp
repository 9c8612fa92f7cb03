// Durations that a bound can have at the rate of a spec.
// Takes: an analysis. Gives: durations that are whole numbers of steps, and how many; none where
// the spec has no rate. Keeps true: their arithmetic is that of check/, exact.
#pragma once

#include <string>
#include <vector>

#include "lsp/spec/analysis.hpp"

namespace etlc::lsp {

struct Duration {
    std::string text;    ///< "0.5 s"
    std::string detail;  ///< "10 steps"
};

/// Usual ones, from short to long.
std::vector<Duration> durations(const Analysis& analysis);

/// The number with each unit; where that is no whole number of steps, the two next to it.
std::vector<Duration> durations_near(const Analysis& analysis, const std::string& number);

}  // namespace etlc::lsp
