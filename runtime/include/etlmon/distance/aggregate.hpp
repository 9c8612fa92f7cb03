// SPDX-License-Identifier: MIT
// From the values of K rows to one: min, max, mean, the n-th smallest; and which row is nearest.
// Takes: rows' values in ascending row order, each a float that is not negative (+inf where it
// overflowed). Gives: the aggregate and the index of the nearest row, the lowest on ties. Keeps
// true: values are compared as the integers of their bits, whose order is theirs; work per row is
// bounded (Kth: n moves), no heap.
#pragma once

#include "etlmon/distance/storage.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

/// What a predicate's distance was: telemetry, and where its robustness comes from.
struct Measured {
  float delta;  ///< the aggregated distance; NaN where it is unknown: a zero vector under cosine or
                ///< angular
  uint32_t nearest;  ///< row of the nearest target, the lowest on ties; 0 where delta is unknown
};

/// What a predicate's distance is where its input is missing.
constexpr Measured kUnmeasured{kMissing, 0};

namespace detail {

/// A Measured as kernels return it: the bits of delta, above them the row. An integer comes back in
/// registers on every machine, and what calls another kernel for its result can jump there, so that
/// it needs no frame.
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
  uint32_t least = 0xffffffffu;  ///< bits of its value; no value is that large
  uint32_t row = 0;

  ETLMON_INLINE void add(uint32_t bits, uint32_t at) noexcept {
#if defined(__OPTIMIZE_SIZE__)
    if (bits < least) {
      least = bits;
      row = at;
    }
#else  // without a branch: any row is as likely as any other
    at = in_register(at);
    row = bits < least ? at : row;
    least = bits < least ? bits : least;
#endif
  }
};

/// Keeps the n smallest values, ascending, in `values`, of which `count` are there.
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
  static constexpr bool kNearest = true;  ///< the result is the nearest row's value
  static constexpr bool kOfDistances =
      false;  ///< order statistics work on values: one finish() for all rows
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

/// The n-th smallest distance, from 1; n known to the compiler.
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
