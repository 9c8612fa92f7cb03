// The distance kernel: one embedding against K targets, aggregated.
// Takes: z of D finite floats; targets K x D row-major, prepared as distances.def says (unit rows for cosine and
// angular); weights D x D or D where the distance has some. Gives: the aggregated distance and the nearest row. Keeps
// true: the order of additions depends on D alone, not on K nor on what is known at compile time, so generated code and
// `etlc run` agree bit for bit under equal flags; nothing is allocated; the time depends on the data only where a sum
// of squares leaves [2^-80, FLT_MAX] and the scaled form (rescaled.hpp) decides. SPDX-License-Identifier: MIT
#pragma once

#include "etlmon/rescaled.hpp"

namespace etlmon {
namespace detail {

/// The sums of one row: element i goes to lane i mod 16 (i mod 4 on machines without vectors), in ascending order.
template <class Metric>
struct Row {
  using Packs = typename Metric::template Partial<Pack>;
  using Lane = typename Metric::template Partial<float>;
  using Point = typename Metric::Point;
  static constexpr uint32_t kBlock = 4 * kPacksPerBlock;
  Packs a{}, b{}, c{}, d{};

  ETLMON_INLINE static void add(Packs& to, const Point& point, const float* z, const float* g,
                                const float* w) noexcept {
    Metric::add(to, point, load<Pack>(z), load<Pack>(g), load<Pack>(w));
  }

  ETLMON_INLINE void add_block(const Point& point, const float* z, const float* g, const float* w) noexcept {
    add(a, point, z, g, w);
    if constexpr (kPacksPerBlock > 1) {
      add(b, point, z + 4, g + 4, w + 4);
      add(c, point, z + 8, g + 8, w + 8);
      add(d, point, z + 12, g + 12, w + 12);
    }
  }

  /// Adds elements i and beyond, fewer than a block, and gives the row's value.
  ETLMON_INLINE float finish(const Point& point, const float* z, const float* g, const float* w, uint32_t i,
                             uint32_t dimension) noexcept {
    Packs packs = a;
    if constexpr (kPacksPerBlock > 1) {
      if (i + 4 <= dimension) add(a, point, z + i, g + i, w + i), i += 4;
      if (i + 4 <= dimension) add(b, point, z + i, g + i, w + i), i += 4;
      if (i + 4 <= dimension) add(c, point, z + i, g + i, w + i), i += 4;
      packs = Metric::combine(Metric::combine(a, b), Metric::combine(c, d));
    }
    Lane first = lane<0>(packs), second = lane<1>(packs), third = lane<2>(packs);
    if (i < dimension) Metric::add(first, point, z[i], g[i], w[i]);
    if (i + 1 < dimension) Metric::add(second, point, z[i + 1], g[i + 1], w[i + 1]);
    if (i + 2 < dimension) Metric::add(third, point, z[i + 2], g[i + 2], w[i + 2]);
    return Metric::row(Metric::combine(Metric::combine(first, third), Metric::combine(second, lane<3>(packs))));
  }
};

/// Values of two rows at once: z is loaded once for both.
template <class Metric>
ETLMON_INLINE void two_rows(const typename Metric::Point& point, const float* z, const float* g, const float* w,
                            uint32_t dimension, float& first, float& second) noexcept {
  Row<Metric> one, two;
  const float* h = g + dimension;
  uint32_t i = 0;
  for (; i + Row<Metric>::kBlock <= dimension; i += Row<Metric>::kBlock) {
    one.add_block(point, z + i, g + i, w + i);
    two.add_block(point, z + i, h + i, w + i);
  }
  first = one.finish(point, z, g, w, i, dimension);
  second = two.finish(point, z, h, w, i, dimension);
}

template <class Metric>
ETLMON_INLINE float one_row(const typename Metric::Point& point, const float* z, const float* g, const float* w,
                            uint32_t dimension) noexcept {
  Row<Metric> row;
  uint32_t i = 0;
  for (; i + Row<Metric>::kBlock <= dimension; i += Row<Metric>::kBlock) row.add_block(point, z + i, g + i, w + i);
  return row.finish(point, z, g, w, i, dimension);
}

/// Elements j.. of (z - g)^T W, times those of z - g.
template <class V>
ETLMON_INLINE V quadratic_terms(const float* z, const float* g, const float* w, uint32_t j,
                                uint32_t dimension) noexcept {
  V column{};
  const float* element = w + j;
  for (uint32_t i = 0; i < dimension; ++i, element += dimension) column = column + load<V>(element) * (z[i] - g[i]);
  return column * (load<V>(z + j) - load<V>(g + j));
}

/// (z - g)^T W (z - g); 0 where rounding made it negative.
template <>
ETLMON_INLINE float one_row<Mahalanobis>(const NoPoint&, const float* z, const float* g, const float* w,
                                         uint32_t dimension) noexcept {
  Pack packs{};
  uint32_t j = 0;
  for (; j + 4 <= dimension; j += 4) packs = packs + quadratic_terms<Pack>(z, g, w, j, dimension);
  float first = lane<0>(packs), second = lane<1>(packs), third = lane<2>(packs);
  if (j < dimension) first += quadratic_terms<float>(z, g, w, j, dimension);
  if (j + 1 < dimension) second += quadratic_terms<float>(z, g, w, j + 1, dimension);
  if (j + 2 < dimension) third += quadratic_terms<float>(z, g, w, j + 2, dimension);
  const float square = (first + third) + (second + lane<3>(packs));
  const uint32_t bits = observe(square);
  return from_bits((bits & kSignBit) != 0 && (bits & ~kSignBit) < kInfinityBits ? 0u : bits);
}

/// |z|^2
struct SquaredLength : Additive {
  template <class V>
  ETLMON_INLINE static void add(Sum<V>& to, NoPoint, V z, V, V) noexcept {
    to.sum = to.sum + z * z;
  }
};

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
  /// No square that matters was lost. Weights can make a far row near: with them no row may have overflowed.
  ETLMON_INLINE bool sound(uint32_t result) const noexcept {
    return nearest.least >= kLeastSquare && result <= kGreatest && greatest <= kGreatest;
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
  if constexpr (Metric::kTwoRows) {
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
  if constexpr (Metric::kRescales) {
    if (!tally.sound(result)) return measure_rescaled<Metric>(z, targets, weights, rows, dimension, aggregation);
  }
  const float delta = Aggregation::kOfDistances ? from_bits(result) : Metric::finish(from_bits(result));
  return {delta, tally.nearest.row};
}

}  // namespace detail

/// The aggregated distance from z, of D finite elements, to K targets: for generated code, whose sizes are constants.
/// Errors: none; delta is NaN where z is zero under cosine and angular, +inf where it exceeds FLT_MAX.
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
