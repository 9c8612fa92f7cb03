// The label of a predicate at a step.
#pragma once

#include <cstdint>

namespace etlc::episodes {

/// Ordered: && is the minimum, || the maximum, unknown in between (Kleene's strong logic).
enum class Label : std::uint8_t { no, unknown, yes };

}  // namespace etlc::episodes
