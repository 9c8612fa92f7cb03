// SPDX-License-Identifier: MIT
// The distances as a table, and what is made of their targets: for etlc and tools on a host.
// Takes: ids of distances.def. Gives: the rows of the table; prepare(...). Keeps true: not part of
// generated headers.
#pragma once

#include <math.h>

#include "etlmon/distance/distances.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

enum class MetricId : uint8_t {
#define DISTANCE(id, Type, prepared, zero_is_unknown) id,
#include "etlmon/distance/distances.def"
#undef DISTANCE
};

enum class AggregationId : uint8_t { min, max, mean, kth };

enum class Prepared : uint8_t { as_given, unit_rows };

/// A row of distances.def.
struct Distance {
  const char* name;   ///< the struct that computes it, `L2` for etlmon::L2
  const char* word;   ///< its id
  float highest;      ///< its range is [0, highest]
  Prepared prepared;  ///< what prepare() makes of targets
  bool zero_is_unknown;
};

inline constexpr Distance kDistances[] = {
#define DISTANCE(id, Type, prepared, zero_is_unknown) \
  {#Type, #id, Type::kHighest, Prepared::prepared, zero_is_unknown},
#include "etlmon/distance/distances.def"
#undef DISTANCE
};

constexpr const Distance& distance(MetricId metric) noexcept {
  return kDistances[static_cast<size_t>(metric)];
}

/// Brings targets, K x D row-major, into the form that measure() takes, in place: cosine and
/// angular want rows of length 1. In double and in fixed order, so every machine makes the same
/// constants. Returns the first row that has no direction, K if all have one (or the distance needs
/// none); such a row is left as it is.
inline uint32_t prepare(MetricId metric, float* targets, uint32_t K, uint32_t D) noexcept {
  if (distance(metric).prepared == Prepared::as_given) return K;
  uint32_t bad = K;
  for (uint32_t row = 0; row < K; ++row) {
    float* g = targets + static_cast<size_t>(row) * D;
    double square = 0;
    for (uint32_t i = 0; i < D; ++i)
      square += static_cast<double>(g[i]) * static_cast<double>(g[i]);
    if (square > 0) {
      const double length = sqrt(square);
      for (uint32_t i = 0; i < D; ++i)
        g[i] = static_cast<float>(static_cast<double>(g[i]) / length);
    } else if (bad == K) {
      bad = row;
    }
  }
  return bad;
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
