// The samples behind a verdict, and the smallest change of one that would flip it.
#pragma once

#include <optional>
#include <vector>

#include "explain/values.hpp"

namespace etlc::explain {

/// Returns the samples that the status needs, by step, then atom, among those whose value is at
/// least as far on its side as `least`. Drops the last ones first, the critical one at the very
/// end.
std::vector<Sample> needed_samples(const Subject& subject, const Judged& judged, etlmon::Key least,
                                   const std::optional<Sample>& critical);

/// Returns the samples within reach that are missing or between two thresholds.
std::vector<Sample> unknown_samples(const Subject& subject);

/// Returns the smallest change of one measurement behind the samples that flips the verdict; a bool
/// only where no other measurement does. Alters the values meanwhile and restores them.
std::optional<Change> smallest_change(const Subject& subject, Judged& judged,
                                      const std::vector<Sample>& samples);

}  // namespace etlc::explain
