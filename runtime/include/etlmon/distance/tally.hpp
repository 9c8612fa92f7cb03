// SPDX-License-Identifier: MIT
// From the values of K rows to the distance of a predicate, and whether they can be trusted.
// Takes: the values of all rows in row order. Gives: the aggregated distance and the nearest row.
// Keeps true: where a square left [2^-80, FLT_MAX] and that could matter, the scaled form
// (rescaled.hpp) decides; a distance of exactly 0 is recognised without it; where an element of z
// is not finite, which makes the value of every row not finite, the distance is unknown.
#pragma once

#include "etlmon/distance/aggregate.hpp"
#include "etlmon/distance/distances.hpp"
#include "etlmon/distance/layout.hpp"
#include "etlmon/distance/storage.hpp"
#include "etlmon/views.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {
namespace detail {

/// The bits of a sum that a loop made. It has to be a float until here: g++ for RISC-V would else
/// keep it in an integer register from the start, and move it to and fro with every addition.
ETLMON_INLINE uint32_t observe_sum(const float& x) noexcept {
#if !defined(ETLMON_GNU) || defined(__riscv_flen)
  return observe(opaque(x));
#else
  return observe(x);
#endif
}

/// K rows of D elements, one after the other, `stride` elements apart.
template <bool InColumns, class Elements>
struct Set {
  Elements values;
  uint32_t rows, dimension, stride;

  struct Buffer {};
  ETLMON_INLINE Elements row(uint32_t k, Buffer&) const noexcept {
    return values + static_cast<size_t>(k) * stride;
  }
};

/// The same in columns.
template <class Elements>
struct Set<true, Elements> {
  Elements values;
  uint32_t rows, dimension, stride;

  ETLMON_INLINE Strided<Elements> elements_of(uint32_t k) const noexcept {
    const Place place = place_in_columns(k, rows, dimension);
    return {values + place.first, place.stride};
  }
#if defined(ETLMON_VECTORS)
  struct Buffer {
    float elements[4 * kLanes];
  };
  /// Row k, gathered in `to`, for those who read it by vectors.
  ETLMON_INLINE const float* row(uint32_t k, Buffer& to) const noexcept {
    const Strided<Elements> from = elements_of(k);
    for (uint32_t i = 0; i < dimension; ++i) to.elements[i] = element(from, i);
    return to.elements;
  }
#else
  struct Buffer {};
  ETLMON_INLINE Strided<Elements> row(uint32_t k, Buffer&) const noexcept { return elements_of(k); }
#endif
};

/// Everything about one measurement but its sizes and its rows: the nearest row, the aggregate,
/// what they say together.
template <class Metric, class Aggregation>
struct Tally {
  Nearest nearest;
  Aggregation aggregation;
  uint32_t greatest = 0;

  ETLMON_INLINE void add(float value, uint32_t row) noexcept { add_bits(observe_sum(value), row); }
  ETLMON_INLINE void add_bits(uint32_t bits, uint32_t row) noexcept {
    nearest.add(bits, row);
    if constexpr (Metric::kWeighted || Metric::kQuadratic)
      greatest = bits > greatest ? bits : greatest;
    if constexpr (Aggregation::kOfDistances) {
      aggregation.add(Metric::finish(from_bits(bits)));
    } else {
      aggregation.add(bits);
    }
  }
  /// Bits of the aggregate: of a distance for the mean, else of a value.
  ETLMON_INLINE uint32_t result(uint32_t rows) const noexcept {
    if constexpr (Aggregation::kOfDistances) {
      return observe(capped<Metric>(aggregation.result(rows)));
    } else {
      return aggregation.result(nearest);
    }
  }
  /// No element of z can have been other than finite, no square that matters was lost, and no sum
  /// of distances overflowed that may have a representable mean. Weights can make a far row near:
  /// with them no row may have overflowed.
  ETLMON_INLINE bool sound(uint32_t result) const noexcept {
    // Values decide, not their roots: clang's -ffast-math takes the root of a NaN for 0.
    if (Aggregation::kOfDistances && nearest.least > kGreatest) return false;
    if (!Metric::kRescales) return result <= kGreatest;
    return nearest.least >= kLeastSquare && result <= kGreatest && greatest <= kGreatest;
  }
  /// The same, for other aggregations than min, where the nearest row turns out to be z itself: its
  /// 0 is exact, and no other row's underflow can matter.
  ETLMON_INLINE bool sound_if_equal(uint32_t result) const noexcept {
    constexpr uint32_t kLeastRoot = 0x2b800000u;  // 2^-40, in doubt whether a square or a root
    return nearest.least == 0 && result >= kLeastRoot && result <= kGreatest &&
           greatest <= kGreatest;
  }
};

/// Every element of z is finite; out of line, since it is asked where a distance is not.
ETLMON_COLD inline bool all_finite(const float* z, uint32_t dimension) noexcept {
  return finite(z, dimension);
}

/// `measured`, or unknown where an element of z is not finite.
ETLMON_COLD inline MeasuredBits unless_unknown(const float* z, uint32_t dimension,
                                               MeasuredBits measured) noexcept {
  return all_finite(z, dimension) ? measured : packed(kUnmeasured);
}

/// The measurement where its values cannot be trusted: a row that equals z decides, or else the
/// scaled form. Unknown where z is missing or an element of it is not finite.
template <class Metric, class Aggregation, class Size, bool InColumns, class Elements>
ETLMON_COLD MeasuredBits measure_again(const float* z, Elements targets, const float* weights,
                                       Size size, Aggregation aggregation) noexcept;

/// Whether a row that is nearest at 0 equals z, so that its 0 is exact.
template <bool Short, bool InColumns, class Elements>
ETLMON_COLD bool is_equal(const float* z, const Set<InColumns, Elements>& set,
                          uint32_t row) noexcept;

/// What the values say together. `aggregation`: as it was before it saw any.
template <bool InColumns, class Metric, class Aggregation, class Size, class Elements>
ETLMON_INLINE MeasuredBits conclude(const Tally<Metric, Aggregation>& tally, const float* z,
                                    Elements targets, const float* weights, Size size,
                                    Aggregation aggregation) noexcept {
  const uint32_t result = tally.result(size.rows());
  bool sound = tally.sound(result);
  if constexpr (Metric::kRescales && !Aggregation::kNearest) {
    if (!sound && tally.sound_if_equal(result)) {
      sound = is_equal<Size::is_short(), InColumns, Elements>(
          z, {targets, size.rows(), size.dimension(), size.stride()}, tally.nearest.row);
    }
  }
  if constexpr (Metric::kRescales || Aggregation::kOfDistances) {
    if (!sound)
      return measure_again<Metric, Aggregation, Size, InColumns, Elements>(z, targets, weights,
                                                                           size, aggregation);
  }
  const float delta =
      Aggregation::kOfDistances ? from_bits(result) : Metric::finish(from_bits(result));
  const MeasuredBits measured = packed({delta, tally.nearest.row});
  if constexpr (!Metric::kDirection) {  // else the length of z has said so
    if (!sound) return unless_unknown(z, size.dimension(), measured);
  }
  return measured;
}

}  // namespace detail
}  // namespace ETLMON_BUILD
}  // namespace etlmon
