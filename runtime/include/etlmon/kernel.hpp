// SPDX-License-Identifier: MIT
// The distance kernel: one embedding against K targets, aggregated.
// Takes: z of D finite floats; targets K x D row-major, prepared as distances.def says (unit rows for cosine and
// angular); weights D x D or D where the distance has some. Gives: the aggregated distance and the nearest row. Keeps
// true: the order of additions depends on D alone, not on K nor on what is known at compile time, so generated code and
// `etlc run` agree bit for bit under equal flags; nothing is allocated; the time depends on the data only where a sum
// of squares leaves [2^-80, FLT_MAX] and the scaled form (rescaled.hpp) decides.
#pragma once

#include "etlmon/rescaled.hpp"

namespace etlmon {
/// What a predicate's distance is where its input is missing.
constexpr Measured kUnmeasured{kMissing, 0};

namespace detail {

/// Everything about one measurement but its sizes and its rows: the nearest row, the aggregate, what they say together.
template <class Metric, class Aggregation>
struct Tally {
  Nearest nearest;
  Aggregation aggregation;
  uint32_t greatest = 0;

  ETLMON_INLINE void add(float value, uint32_t row) noexcept {
    const uint32_t bits = observe(value);
    nearest.add(bits, row);
    if constexpr (Metric::kWeighted || Metric::kQuadratic) greatest = bits > greatest ? bits : greatest;
    if constexpr (Aggregation::kOfDistances) {
      aggregation.add(Metric::finish(from_bits(bits)));
    } else {
      aggregation.add(bits);
    }
  }
  /// Bits of the aggregate: of a distance for the mean, else of a value.
  ETLMON_INLINE uint32_t result(uint32_t rows) const noexcept {
    if constexpr (Aggregation::kOfDistances) {
      return observe(aggregation.result(rows));
    } else {
      return aggregation.result(nearest);
    }
  }
  /// No square that matters was lost, and no sum of distances overflowed that may have a representable mean. Weights
  /// can make a far row near: with them no row may have overflowed.
  ETLMON_INLINE bool sound(uint32_t result) const noexcept {
    if (!Metric::kRescales) return result <= kGreatest || !Aggregation::kOfDistances;
    return nearest.least >= kLeastSquare && result <= kGreatest && greatest <= kGreatest;
  }
  /// The same where the nearest row turns out to be z itself: its 0 is exact, and no other row's underflow can matter.
  ETLMON_INLINE bool sound_if_equal(uint32_t result) const noexcept {
    constexpr uint32_t kLeastRoot = 0x2b800000u;  // 2^-40, in doubt whether a square or a root
    const bool exact = Aggregation::kNearest ? result == 0 : result >= kLeastRoot;
    return nearest.least == 0 && exact && result <= kGreatest && greatest <= kGreatest;
  }
};

template <class Metric, class Aggregation>
ETLMON_INLINE Measured measure_rows(const float* z, const float* targets, const float* weights, uint32_t rows,
                                    uint32_t dimension, Aggregation aggregation) noexcept {
  typename Metric::Point point{};
  if constexpr (Metric::kDirection) {
    const uint32_t square = observe(one_row<SquaredLength>({}, z, z, z, dimension));
    if (square < kLeastSquare || square > kGreatestSquare) {
      return measure_rescaled<Metric>(z, targets, weights, rows, dimension, aggregation);
    }
    point.scale = 1.0f / square_root(from_bits(square));
  }

  const float* w = Metric::kWeighted || Metric::kQuadratic ? weights : z;  // unread where there are none
  Tally<Metric, Aggregation> tally{{}, aggregation};
  uint32_t row = 0;
  if constexpr (Metric::kTwoRows && kPacksPerBlock > 1) {
    for (; row + 2 <= rows; row += 2) {
      float first = 0.0f, second = 0.0f;
      two_rows<Metric>(point, z, targets + static_cast<size_t>(row) * dimension, w, dimension, first, second);
      tally.add(first, row);
      tally.add(second, row + 1);
    }
  }
  for (; row < rows; ++row) {
    tally.add(one_row<Metric>(point, z, targets + static_cast<size_t>(row) * dimension, w, dimension), row);
  }

  const uint32_t result = tally.result(rows);
  if constexpr (Metric::kRescales || Aggregation::kOfDistances) {
    bool sound = tally.sound(result);
    if constexpr (Metric::kWeighted || Metric::kQuadratic) {  // whose scaled form is slow
      if (!sound && tally.sound_if_equal(result)) {
        sound = equal(z, targets + static_cast<size_t>(tally.nearest.row) * dimension, dimension);
      }
    }
    if (!sound) return measure_rescaled<Metric>(z, targets, weights, rows, dimension, aggregation);
  }
  const float delta = Aggregation::kOfDistances ? from_bits(result) : Metric::finish(from_bits(result));
  return {delta, tally.nearest.row};
}

}  // namespace detail

/// The aggregated distance from z, of D finite elements, to K targets: for generated code, whose sizes are constants.
/// Errors: none; delta is NaN where z is zero under cosine and angular, +inf where it, or for the mean one of the
/// distances, exceeds FLT_MAX; distances that do are taken for equal.
template <class Metric, class Aggregation, uint32_t K, uint32_t D>
ETLMON_INLINE Measured measure(const float* z, const float (&targets)[K * D]) noexcept {
  static_assert(!Metric::kWeighted && !Metric::kQuadratic, "this distance needs weights");
  return detail::measure_rows<Metric>(z, targets, nullptr, K, D, Aggregation{});
}

/// The same for distances with weights: D x D symmetric positive definite (Mahalanobis) or D positive
/// (MahalanobisDiagonal).
template <class Metric, class Aggregation, uint32_t K, uint32_t D>
ETLMON_INLINE Measured measure(const float* z, const float (&targets)[K * D],
                               const float (&weights)[Metric::kQuadratic ? D * D : D]) noexcept {
  static_assert(Metric::kWeighted || Metric::kQuadratic, "this distance has no weights");
  return detail::measure_rows<Metric>(z, targets, weights, K, D, Aggregation{});
}

}  // namespace etlmon
