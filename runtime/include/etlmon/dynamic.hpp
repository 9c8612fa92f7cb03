// SPDX-License-Identifier: MIT
// The kernel with sizes, distance and aggregation known at run time: for `etlc run`, calibration
// and tools on a host. Takes: ids of distances.def, targets K x D row-major. Gives: what
// measure<Metric, Aggregation, K, D> gives, bit for bit under equal flags, since both inline the
// same rows; the table of distances; the preparation of targets. Keeps true: allocates nothing; not
// part of generated headers.
#pragma once

#include <math.h>

#include "etlmon/kernel.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

enum class MetricId : uint8_t {
#define DISTANCE(id, Type, prepared, zero_is_unknown) id,
#include "etlmon/distances.def"
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
#include "etlmon/distances.def"
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

template <class Metric, class G>
Measured measure_as(AggregationId aggregation, uint32_t n, const float* z, G targets, uint32_t K,
                    uint32_t D, const float* weights, float* scratch) noexcept {
  switch (aggregation) {
    case AggregationId::min:
      return best<Metric, Min, Sizes, false>(z, targets, weights, {K, D}, Min{});
    case AggregationId::max:
      return best<Metric, Max, Sizes, false>(z, targets, weights, {K, D}, Max{});
    case AggregationId::mean:
      return best<Metric, Mean, Sizes, false>(z, targets, weights, {K, D}, Mean{});
    case AggregationId::kth:
      break;
  }
  return best<Metric, KthOf, Sizes, false>(z, targets, weights, {K, D}, KthOf{scratch, n, 0});
}

template <class G>
Measured measure_as(MetricId metric, AggregationId aggregation, uint32_t n, const float* z,
                    G targets, uint32_t K, uint32_t D, const float* weights,
                    float* scratch) noexcept {
  switch (metric) {
#define DISTANCE(id, Type, prepared, zero_is_unknown) \
  case MetricId::id:                                  \
    return measure_as<Type>(aggregation, n, z, targets, K, D, weights, scratch);
#include "etlmon/distances.def"
#undef DISTANCE
  }
  return {from_bits(kMissingBits), 0};
}

}  // namespace detail

/// The aggregated distance from z (D floats; NaN where one is not finite) to K prepared targets.
/// weights: D x D for mahalanobis, D for mahalanobis_diagonal, else unread. kth takes n in [1, K]
/// and scratch of n floats, else unread.
inline Measured measure(MetricId metric, AggregationId aggregation, uint32_t n, const float* z,
                        const float* targets, uint32_t K, uint32_t D, const float* weights,
                        float* scratch) noexcept {
  return detail::measure_as(metric, aggregation, n, z, targets, K, D, weights, scratch);
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
