// SPDX-License-Identifier: MIT
// The value of one row of targets, or of two at once.
// Takes: z, a row g and weights, D floats each (D x D weights for Mahalanobis). Gives: the sum over all elements that a
// struct of distances.hpp describes. Keeps true: a fixed order of additions: element i goes to lane i mod 16 (i mod 4
// on machines without vectors) in ascending order, then lanes are added in pairs; the order depends on D alone.
#pragma once

#include "etlmon/distances.hpp"

namespace etlmon {
namespace detail {

/// The sums of one row: named accumulators, straight-line code per block.
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

}  // namespace detail
}  // namespace etlmon
