// SPDX-License-Identifier: MIT
// The distance of a predicate from the values of rows, and whether these are accurate. Takes: the
// values of all rows in row order. Gives: the aggregated distance and the nearest row. Keeps true:
// if a square left [2^-80, FLT_MAX] and that could matter, the scaled form (rescaled.hpp) is used;
// a distance of exactly 0 is recognised without it; if an element of z is not finite, so is the
// value of every row, and the distance is unknown.
#pragma once

#include "etlmon/distance/aggregate.hpp"
#include "etlmon/distance/distances.hpp"
#include "etlmon/distance/layout.hpp"
#include "etlmon/distance/storage.hpp"
#include "etlmon/views.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {
namespace detail {

/// Returns the bits of a sum. The sum stays a float until here: g++ for RISC-V would otherwise keep
/// it in an integer register, and move it for every addition.
ETLMON_INLINE uint32_t observe_sum(const float& x) noexcept {
#if !defined(ETLMON_GNU) || defined(__riscv_flen)
  return observe(opaque(x));
#else
  return observe(x);
#endif
}

/// Rows of `dimension` elements, `stride` elements apart.
template <bool InColumns, class Elements>
struct Set {
  Elements values;
  uint32_t rows, dimension, stride;

  struct Buffer {};
  ETLMON_INLINE Elements row(uint32_t k, Buffer&) const noexcept {
    return values + static_cast<size_t>(k) * stride;
  }
};

/// A set in columns.
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
  /// Returns row k, gathered in a buffer to be read by vectors.
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

/// The state of one measurement: the nearest row and the aggregate.
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
  /// Returns the bits of the aggregate: of a distance for the mean, otherwise of a value.
  ETLMON_INLINE uint32_t result(uint32_t rows) const noexcept {
    if constexpr (Aggregation::kOfDistances) {
      return observe(capped<Metric>(aggregation.result(rows)));
    } else {
      return aggregation.result(nearest);
    }
  }
  /// Returns whether all elements of z are finite, no square that matters was lost, and no sum of
  /// distances overflowed that may have a representable mean. With weights, which can make a far
  /// row near, no row may have overflowed.
  ETLMON_INLINE bool sound(uint32_t result) const noexcept {
    // Checks values, not their roots: under clang's -ffast-math the root of a NaN may be 0.
    if (Aggregation::kOfDistances && nearest.least > kGreatest) return false;
    if (!Metric::kRescales) return result <= kGreatest;
    return nearest.least >= kLeastSquare && result <= kGreatest && greatest <= kGreatest;
  }
  /// Returns the same for other aggregations than min, if the nearest row equals z: its 0 is exact,
  /// and underflow of other rows does not matter.
  ETLMON_INLINE bool sound_if_equal(uint32_t result) const noexcept {
    constexpr uint32_t kLeastRoot = 0x2b800000u;  // 2^-40, for a square or a root
    return nearest.least == 0 && result >= kLeastRoot && result <= kGreatest &&
           greatest <= kGreatest;
  }
};

/// Returns whether every element of z is finite. Not inlined, since it is rarely called.
ETLMON_COLD inline bool all_finite(const float* z, uint32_t dimension) noexcept {
  return finite(z, dimension);
}

/// Returns `measured`, or unknown if an element of z is not finite.
ETLMON_COLD inline MeasuredBits unless_unknown(const float* z, uint32_t dimension,
                                               MeasuredBits measured) noexcept {
  return all_finite(z, dimension) ? measured : packed(kUnmeasured);
}

/// Measures again if values are inaccurate: uses a row that equals z, or else the scaled form.
/// Unknown if z is missing or an element of it is not finite.
template <class Metric, class Aggregation, class Size, bool InColumns, class Elements>
ETLMON_COLD MeasuredBits measure_again(const float* z, Elements targets, const float* weights,
                                       Size size, Aggregation aggregation) noexcept;

/// Returns whether the nearest row, at 0, equals z, so that its 0 is exact.
template <bool Short, bool InColumns, class Elements>
ETLMON_COLD bool is_equal(const float* z, const Set<InColumns, Elements>& set,
                          uint32_t row) noexcept;

/// Returns the result of all values. `aggregation`: its initial state.
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
  if constexpr (!Metric::kDirection) {  // otherwise the length of z shows it
    if (!sound) return unless_unknown(z, size.dimension(), measured);
  }
  return measured;
}

}  // namespace detail
}  // namespace ETLMON_BUILD
}  // namespace etlmon
