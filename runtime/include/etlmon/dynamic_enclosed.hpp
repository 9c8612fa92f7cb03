// SPDX-License-Identifier: MIT
// enclosed.hpp with distance and aggregation known at run time: for `etlc run` and tests.
// Takes: ids of distances.def, and what was measured on narrow rows, or on float32 rows that hold
// what the narrow ones widen to: the kernels give both the same bits; or int8 rows to measure on.
// Gives: the interval that enclose<Metric>() or measure_bytes<...>() gives. Keeps true: not part of
// generated headers.
#pragma once

#include "etlmon/bytes.hpp"
#include "etlmon/dynamic.hpp"

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

/// Rows of int8, and what comes with them.
struct ByteRows {
  const int8_t* values;
  const int32_t* sums;  ///< of each row the sum of its squares, then of each the sum
  float scale, moved;
  uint32_t rows, dimension;
};

namespace detail {

template <class Metric, class Aggregation>
Enclosed measure_bytes_as(const float* z, const ByteRows& of, uint8_t* scratch,
                          Aggregation aggregation) noexcept {
  const uint32_t averaged = Aggregation::kOfDistances ? of.rows : 0;
  const ScaledRows rows{of.values, of.scale};
  const Sizes size{of.rows, of.dimension};
#if defined(ETLMON_X86_64)
  const auto measured =
      best_in_integers<Metric, Aggregation>(z, rows, of.sums, scratch, size, aggregation);
  return enclose_integers<Metric>(measured, of.moved, of.dimension, averaged);
#else
  static_cast<void>(scratch);
  return enclose<Metric>(
      best<Metric, Aggregation, Sizes, false>(z, rows, nullptr, size, aggregation), of.moved,
      of.dimension, averaged);
#endif
}
template <class Metric>
Enclosed measure_bytes_as(AggregationId aggregation, uint32_t n, const float* z,
                          const ByteRows& rows, uint8_t* scratch, float* kept) noexcept {
  switch (aggregation) {
    case AggregationId::min:
      return measure_bytes_as<Metric>(z, rows, scratch, Min{});
    case AggregationId::max:
      return measure_bytes_as<Metric>(z, rows, scratch, Max{});
    case AggregationId::mean:
      return measure_bytes_as<Metric>(z, rows, scratch, Mean{});
    case AggregationId::kth:
      break;
  }
  return measure_bytes_as<Metric>(z, rows, scratch, KthOf{kept, n, 0});
}

}  // namespace detail

/// measure_bytes() of bytes.hpp for l2, l2sq, cosine and angular. `scratch`:
/// detail::bytes_scratch(D) bytes; `kept`: n floats for kth, which takes n in [1, K].
inline Enclosed measure_bytes(MetricId metric, AggregationId aggregation, uint32_t n,
                              const float* z, const ByteRows& rows, uint8_t* scratch,
                              float* kept) noexcept {
  if (metric == MetricId::l2)
    return detail::measure_bytes_as<L2>(aggregation, n, z, rows, scratch, kept);
  if (metric == MetricId::l2sq)
    return detail::measure_bytes_as<L2Sq>(aggregation, n, z, rows, scratch, kept);
  if (metric == MetricId::cosine)
    return detail::measure_bytes_as<Cosine>(aggregation, n, z, rows, scratch, kept);
  if (metric == MetricId::angular)
    return detail::measure_bytes_as<Angular>(aggregation, n, z, rows, scratch, kept);
  return {};
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
