// SPDX-License-Identifier: MIT
// dynamic.hpp for target sets in narrow storage: for `etlc run` and tests.
// Takes: ids of distances.def, targets K x D in float16 or int8. Gives: what measure, measure_scaled and enclose give
// for constants, bit for bit under equal flags. Keeps true: allocates nothing; not part of generated headers.
#pragma once

#include "etlmon/dynamic.hpp"
#include "etlmon/enclosed.hpp"

namespace etlmon {

/// As measure() of dynamic.hpp, for targets of float16, given as their bits.
inline Measured measure(MetricId metric, AggregationId aggregation, uint32_t n, const float* z, const uint16_t* targets,
                        uint32_t K, uint32_t D, const float* weights, float* scratch) noexcept {
  return detail::measure_as(metric, aggregation, n, z, targets, K, D, weights, scratch);
}

/// As measure() of dynamic.hpp, for targets of int8, each worth `scale` times itself.
inline Measured measure_scaled(MetricId metric, AggregationId aggregation, uint32_t n, const float* z,
                               const int8_t* targets, float scale, uint32_t K, uint32_t D, const float* weights,
                               float* scratch) noexcept {
  return detail::measure_as(metric, aggregation, n, z, detail::ScaledRows{targets, scale}, K, D, weights, scratch);
}

/// enclose() of enclosed.hpp; not for mahalanobis, of which nothing is known.
inline Enclosed enclose(MetricId metric, AggregationId aggregation, const Measured& narrow, float moved, uint32_t K,
                        uint32_t D) noexcept {
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

}  // namespace etlmon
