// SPDX-License-Identifier: MIT
// The table of distances, and the preparation of their targets, for etlc and tools on a host.
// Takes: ids of distances.def. Gives: the rows of the table; prepare(...). Not part of generated
// headers.
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
  const char* name;   ///< struct that computes it, `L2` for etlmon::L2
  const char* word;   ///< word of the language
  float highest;      ///< the range is [0, highest]
  Prepared prepared;  ///< form of prepared targets
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

/// Prepares targets, K x D, row-major, for measure(), in place: scales rows to length 1 for cosine
/// and angular. Uses double and a fixed order, so every machine makes the same constants. Returns
/// the first row without a direction, which is not changed; K if all have one or need none.
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
