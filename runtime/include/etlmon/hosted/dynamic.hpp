// SPDX-License-Identifier: MIT
// The kernel with sizes, distance and aggregation known at run time: for `etlc run`, calibration
// and tools on a host. Takes: ids of distances.def, targets K x D, row-major. Gives: the results of
// measure<Metric, Aggregation, K, D>, bit for bit under equal flags, since both inline the same
// code. Keeps true: only the values of rows are compiled once per instruction set and distance, not
// the aggregation. Allocates nothing; not part of generated headers.
#pragma once

#include "etlmon/distance/kernel.hpp"
#include "etlmon/distance/project.hpp"
#include "etlmon/hosted/table.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

/// The n-th smallest distance, n known at run time.
struct KthOf {
  static constexpr bool kNearest = false;
  static constexpr bool kOfDistances = false;
  float* values;  ///< scratch of n floats
  uint32_t n;
  uint32_t count;
  ETLMON_INLINE void add(uint32_t bits) noexcept { detail::keep_smallest(values, n, count, bits); }
  ETLMON_INLINE uint32_t result(const detail::Nearest&) const noexcept {
    return detail::observe(values[n - 1]);
  }
};

namespace detail {

/// Aggregates rows. `row_values`: best_row_values, or that of one version.
template <class Metric, class Aggregation, class G, class RowValues>
Measured aggregate_rows(RowValues row_values, const float* z, G targets, uint32_t K, uint32_t D,
                        const float* weights, Aggregation aggregation) noexcept {
  constexpr uint32_t kTogether = 64;
  float values[kTogether];
  const Sizes size{K, D};
  Tally<Metric, Aggregation> tally{{}, aggregation};
  for (uint32_t row = 0; row < K; row += kTogether) {
    const uint32_t end = K - row < kTogether ? K : row + kTogether;
    if (!row_values(z, targets, weights, row, end, size, values)) {
      return unpacked(
          measure_again<Metric, Aggregation, Sizes, false>(z, targets, weights, size, aggregation));
    }
    for (uint32_t k = row; k < end; ++k) tally.add(values[k - row], k);
  }
  return unpacked(conclude<false>(tally, z, targets, weights, size, aggregation));
}

template <class Metric, class G, class RowValues>
Measured aggregate_rows(RowValues row_values, AggregationId aggregation, uint32_t n, const float* z,
                        G targets, uint32_t K, uint32_t D, const float* weights,
                        float* scratch) noexcept {
  switch (aggregation) {
    case AggregationId::min:
      return aggregate_rows<Metric>(row_values, z, targets, K, D, weights, Min{});
    case AggregationId::max:
      return aggregate_rows<Metric>(row_values, z, targets, K, D, weights, Max{});
    case AggregationId::mean:
      return aggregate_rows<Metric>(row_values, z, targets, K, D, weights, Mean{});
    case AggregationId::kth:
      break;
  }
  return aggregate_rows<Metric>(row_values, z, targets, K, D, weights, KthOf{scratch, n, 0});
}

template <class Metric, class G>
Measured measure_as(AggregationId aggregation, uint32_t n, const float* z, G targets, uint32_t K,
                    uint32_t D, const float* weights, float* scratch) noexcept {
  return aggregate_rows<Metric>(best_row_values<Metric, G>, aggregation, n, z, targets, K, D,
                                weights, scratch);
}

template <class G>
Measured measure_as(MetricId metric, AggregationId aggregation, uint32_t n, const float* z,
                    G targets, uint32_t K, uint32_t D, const float* weights,
                    float* scratch) noexcept {
  switch (metric) {
#define DISTANCE(id, Type, prepared, zero_is_unknown) \
  case MetricId::id:                                  \
    return measure_as<Type>(aggregation, n, z, targets, K, D, weights, scratch);
#include "etlmon/distance/distances.def"
#undef DISTANCE
  }
  return {from_bits(kMissingBits), 0};
}

}  // namespace detail

/// Returns the aggregated distance from z (D floats) to K prepared targets; NaN if an element of z
/// is not finite. weights: D x D for mahalanobis, D for mahalanobis_diagonal, otherwise unused. n
/// in [1, K] and scratch of n floats: for kth, otherwise unused.
inline Measured measure(MetricId metric, AggregationId aggregation, uint32_t n, const float* z,
                        const float* targets, uint32_t K, uint32_t D, const float* weights,
                        float* scratch) noexcept {
  return detail::measure_as(metric, aggregation, n, z, targets, K, D, weights, scratch);
}

/// Stores A (z - m) in y, R floats, as project<R, D> does. `centred`: scratch of D floats if there
/// is an offset, otherwise null. Returns false if the result is unknown.
inline bool project(const float* z, const float* matrix, const float* offset, uint32_t R,
                    uint32_t D, float* centred, float* y) noexcept {
  if (offset != nullptr) detail::subtract(z, offset, D, centred);
  return detail::products(offset == nullptr ? z : centred, matrix, R, D, y) != nullptr;
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
