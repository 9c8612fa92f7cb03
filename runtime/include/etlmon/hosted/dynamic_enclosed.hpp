// SPDX-License-Identifier: MIT
// enclosed.hpp with distance and aggregation known at run time: for `etlc run` and tests. Takes:
// ids of distances.def, and the distance to narrow rows, or to the float32 rows that they widen to,
// which has the same bits. Gives: the interval of enclose<Metric>(). Not part of generated headers.
#pragma once

#include "etlmon/distance/enclosed.hpp"
#include "etlmon/hosted/table.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

/// Calls enclose() of enclosed.hpp; not for mahalanobis, which has no bound.
inline Enclosed enclose(MetricId metric, AggregationId aggregation, const Measured& narrow,
                        float moved, uint32_t K, uint32_t D) noexcept {
  const uint32_t averaged = aggregation == AggregationId::mean ? K : 0;
  switch (metric) {
#define DISTANCE(id, Type, prepared, zero_is_unknown)   \
  case MetricId::id:                                    \
    if constexpr (!Type::kQuadratic) {                  \
      return enclose<Type>(narrow, moved, D, averaged); \
    }                                                   \
    break;
#include "etlmon/distance/distances.def"
#undef DISTANCE
  }
  return {};
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
