// SPDX-License-Identifier: MIT
// Aggregation of the values of rows: min, max, mean, the n-th smallest; and the nearest row. Takes:
// the values in row order, floats that are not negative (+inf after overflow). Gives: the aggregate
// and the index of the nearest row, the lowest on ties. Keeps true: values are compared by their
// bits as integers, which have the same order; work per row is bounded (Kth: n moves); no heap.
#pragma once

#include "etlmon/distance/storage.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

/// The distance of a predicate, for its robustness and telemetry.
struct Measured {
  float delta;  ///< the aggregated distance; NaN if unknown, also of a zero vector under cosine or
                ///< angular
  uint32_t nearest;  ///< row of the nearest target, the lowest on ties; 0 if delta is unknown
};

/// The distance of a predicate whose input is missing.
constexpr Measured kUnmeasured{kMissing, 0};

namespace detail {

/// A Measured as an integer: the row above the bits of delta. Every machine returns it in
/// registers, and a kernel that calls another for its result needs no frame.
using MeasuredBits = uint64_t;
ETLMON_INLINE MeasuredBits packed(uint32_t delta, uint32_t nearest) noexcept {
  return static_cast<MeasuredBits>(nearest) << 32 | delta;
}
ETLMON_INLINE MeasuredBits packed(Measured m) noexcept {
  return packed(observe(m.delta), m.nearest);
}
ETLMON_INLINE Measured unpacked(MeasuredBits m) noexcept {
  return {from_bits(static_cast<uint32_t>(m)), static_cast<uint32_t>(m >> 32)};
}

/// The nearest row so far.
struct Nearest {
  uint32_t least = 0xffffffffu;  ///< bits of its value; larger than any value
  uint32_t row = 0;

  ETLMON_INLINE void add(uint32_t bits, uint32_t at) noexcept {
#if defined(__OPTIMIZE_SIZE__)
    if (bits < least) {
      least = bits;
      row = at;
    }
#else  // without a branch, since rows are equally likely
    at = in_register(at);
    row = bits < least ? at : row;
    least = bits < least ? bits : least;
#endif
  }
};

/// Keeps the n smallest values in `values`, ascending; `count` of them are set.
ETLMON_INLINE void keep_smallest(float* values, uint32_t n, uint32_t& count,
                                 uint32_t bits) noexcept {
  if (count == n && bits >= observe(values[n - 1])) return;
  uint32_t at = count < n ? count++ : n - 1;
  for (; at > 0 && bits < observe(values[at - 1]); --at) values[at] = values[at - 1];
  values[at] = from_bits(bits);
}

}  // namespace detail

/// The distance of the nearest target.
struct Min {
  static constexpr bool kNearest = true;  ///< the result is the value of the nearest row
  static constexpr bool kOfDistances =
      false;  ///< order statistics are computed on values: one finish() for all rows
  ETLMON_INLINE void add(uint32_t) noexcept {}
  ETLMON_INLINE uint32_t result(const detail::Nearest& nearest) const noexcept {
    return nearest.least;
  }
};

/// The distance of the farthest target.
struct Max {
  static constexpr bool kNearest = false;
  static constexpr bool kOfDistances = false;
  ETLMON_INLINE void add(uint32_t bits) noexcept { greatest = bits > greatest ? bits : greatest; }
  ETLMON_INLINE uint32_t result(const detail::Nearest&) const noexcept { return greatest; }
  uint32_t greatest = 0;
};

/// The arithmetic mean of the distances, added in row order.
struct Mean {
  static constexpr bool kNearest = false;
  static constexpr bool kOfDistances = true;
  ETLMON_INLINE void add(float distance) noexcept { sum += distance; }
  ETLMON_INLINE float result(uint32_t rows) const noexcept {
    return sum / static_cast<float>(rows);
  }
  float sum = 0.0f;
};

/// The Nth smallest distance, from 1.
template <uint32_t Nth>
struct Kth {
  static constexpr bool kNearest = false;
  static constexpr bool kOfDistances = false;
  static_assert(Nth >= 1, "the n-th smallest counts from 1");
  ETLMON_INLINE void add(uint32_t bits) noexcept {
    detail::keep_smallest(values, Nth, count, bits);
  }
  ETLMON_INLINE uint32_t result(const detail::Nearest&) const noexcept {
    return detail::observe(values[Nth - 1]);
  }
  float values[Nth] = {};
  uint32_t count = 0;
};

}  // namespace ETLMON_BUILD
}  // namespace etlmon
