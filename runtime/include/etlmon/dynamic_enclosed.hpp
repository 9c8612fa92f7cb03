// SPDX-License-Identifier: MIT
// enclosed.hpp with distance and aggregation known at run time: for `etlc run` and tests.
// Takes: ids of distances.def, and what was measured on narrow rows, or on float32 rows that hold
// what the narrow ones widen to: the kernels give both the same bits. Gives: the interval that
// enclose<Metric>() gives. Keeps true: not part of generated headers.
#pragma once

#include "etlmon/dynamic.hpp"
#include "etlmon/enclosed.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

/// enclose() of enclosed.hpp; not for mahalanobis, of which nothing is known.
inline Enclosed enclose(MetricId metric, AggregationId aggregation, const Measured& narrow,
                        float moved, uint32_t K, uint32_t D) noexcept {
  const uint32_t averaged = aggregation == AggregationId::mean ? K : 0;
  switch (metric) {
    case MetricId::l2:
    case MetricId::mahalanobis_diagonal:
      return enclose<L2>(narrow, moved, D, averaged);
    case MetricId::l2sq:
      return enclose<L2Sq>(narrow, moved, D, averaged);
    case MetricId::l1:
      return enclose<L1>(narrow, moved, D, averaged);
    case MetricId::linf:
      return enclose<Linf>(narrow, moved, D, averaged);
    case MetricId::cosine:
      return enclose<Cosine>(narrow, moved, D, averaged);
    case MetricId::angular:
      return enclose<Angular>(narrow, moved, D, averaged);
    case MetricId::mahalanobis:
      break;
  }
  return {};
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
