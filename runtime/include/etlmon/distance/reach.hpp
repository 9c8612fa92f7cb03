// SPDX-License-Identifier: MIT
// How much nearer a row can have come since its distance was last known: the triangle inequality,
// with room for every rounding. Takes: values as the kernels compute them (bits of floats that are
// not negative). Gives: bounds on values. Keeps true: what is excluded by a bound would not have
// been the nearest row, bit for bit.
//
// Let d be a distance in real arithmetic between float32 vectors (for cosine |u - g|, u = z / |z|
// as it was rounded), V its computed value: d^2 for l2, l2sq and cosine, d for l1 and linf.
// error_bounds.hpp: V is d^2, or d, but for a factor in [1 - e, 1 + e], e = (D/2 + 16) eps, and D
// FLT_MIN < 2^-100. A row had the value L when z stood at the anchor; z has moved by the value M
// since; the nearest row so far has the value B. By the triangle inequality
//   d(z, g) >= d(anchor, g) - d(anchor, z) >= sqrt(L / (1 + e)) - sqrt((M + 2^-100) / (1 - e)),
// and V > B follows from d(z, g) > sqrt((B + 2^-100) / (1 - e)), that is from
//   sqrt L > sqrt((1 + e) / (1 - e)) (sqrt(B + 2^-100) + sqrt(M + 2^-100)),
// and for l1 and linf from the same without roots. For D <= 2^20, e <= 1/16 + 2^-19 and (1 + e) /
// (1 - e) <= 1 + 2.2 e; the factor used, 1 + 2.5 e, and 8 eps for the roundings on the way here, is
// greater than both.
#pragma once

#include "etlmon/distance/distances.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {
namespace detail {

constexpr uint32_t kBlockRows = 64;  ///< rows that are remembered together
constexpr uint32_t kLookAgain =
    16;  ///< where rows were not left early, every so many blocks it is tried again
constexpr uint32_t blocks_of(uint32_t rows) noexcept {
  return rows / kBlockRows + (rows % kBlockRows != 0);
}

/// What a search keeps between steps.
struct SearchView {
  float* anchor;    ///< D: z, for cosine of length 1, when the blocks were last measured
  uint32_t* least;  ///< per block: bits of at most the least value of its rows, as seen from there
  uint32_t* nearest;   ///< row
  uint32_t* measured;  ///< blocks measured since; as many as there are blocks: there is no anchor
};

/// The distances that this holds for, and whether their values are squares.
template <class Metric>
struct Reach {
  static constexpr bool kKnown = false;
};
template <bool Square>
struct ReachKnown {
  static constexpr bool kKnown = true, kSquare = Square;
};
template <>
struct Reach<L2> : ReachKnown<true> {};
template <>
struct Reach<L2Sq> : ReachKnown<true> {};
template <>
struct Reach<Cosine> : ReachKnown<true> {};
template <>
struct Reach<L1> : ReachKnown<false> {};
template <>
struct Reach<Linf> : ReachKnown<false> {};

/// Rows that had a greater value at the anchor have one greater than `best` now. Cosine's values
/// end at 2, where a row that is clipped could only tie: the bound is then above 2, and no
/// remembered value is.
template <class Metric>
ETLMON_INLINE uint32_t reach_of(uint32_t best, uint32_t moved, uint32_t dimension) noexcept {
  constexpr uint32_t kNothing = 0xffffffffu;
  if (best > kGreatestSquare || moved > kGreatestSquare) return kNothing;
  const float room = 1.0f + (1.25f * static_cast<float>(dimension) + 48.0f) * FLT_EPSILON;
  const float least =
      from_bits(kLeastSquare);  // far above 2^-100: what underflow loses is below a rounding of it
  const float b = from_bits(best) > least ? from_bits(best) : least;
  const float m = from_bits(moved) > least ? from_bits(moved) : least;
  if constexpr (Reach<Metric>::kSquare) {
    const float root = rounded(square_root(b) + square_root(m)) * room;
    return observe(rounded(root * root));
  } else {
    return observe(rounded(rounded(b + m) * room));
  }
}

/// Beyond this a row is not measured to its end when blocks are remembered: twice the nearest
/// distance, so that its block can still be left out after the embedding has moved.
template <class Metric>
ETLMON_INLINE uint32_t room_beyond(uint32_t best) noexcept {
  constexpr uint32_t kTwice = 1u << 23;
  const uint32_t more = Reach<Metric>::kSquare ? 2 * kTwice : kTwice;
  return best < kInfinityBits - more ? best + more : kInfinityBits;
}

}  // namespace detail
}  // namespace ETLMON_BUILD
}  // namespace etlmon
