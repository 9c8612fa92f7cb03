// SPDX-License-Identifier: MIT
// Bounds on how much nearer a row can have come since it was measured: the triangle inequality,
// with a margin for every rounding. Takes: values of the kernels (bits of floats that are not
// negative). Gives: bounds on values. Keeps true: a row that a bound excludes is not the nearest
// row, bit for bit.  Let d be a distance in real arithmetic between float32 vectors (for cosine |u
// - g|, u = z / |z| as it was rounded), V its computed value: d^2 for l2, l2sq and cosine, d for l1
// and linf. error_bounds.hpp: V is d^2, or d, but for a factor in [1 - e, 1 + e], e = (D/2 + 16)
// eps, and D FLT_MIN < 2^-100. A row had the value L when z stood at the anchor; z has moved by the
// value M since; the nearest row so far has the value B. By the triangle inequality d(z, g) >=
// d(anchor, g) - d(anchor, z) >= sqrt(L / (1 + e)) - sqrt((M + 2^-100) / (1 - e)), and V > B
// follows from d(z, g) > sqrt((B + 2^-100) / (1 - e)), that is from sqrt L > sqrt((1 + e) / (1 -
// e)) (sqrt(B + 2^-100) + sqrt(M + 2^-100)), and for l1 and linf from the same without roots. For D
// <= 2^20, e <= 1/16 + 2^-19 and (1 + e) / (1 - e) <= 1 + 2.2 e; the factor used, 1 + 2.5 e, and 8
// eps for the roundings on the way here, is greater than both.
#pragma once

#include "etlmon/distance/distances.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {
namespace detail {

constexpr uint32_t kBlockRows = 64;  ///< rows of a block
constexpr uint32_t kLookAgain =
    16;  ///< if rows are not left early, tries again after this many blocks
constexpr uint32_t blocks_of(uint32_t rows) noexcept {
  return rows / kBlockRows + (rows % kBlockRows != 0);
}

/// The state of a search.
struct SearchView {
  float* anchor;       ///< z when the blocks were last measured, for cosine scaled to length 1
  uint32_t* least;     ///< per block: bits of a lower bound of its rows' values from the anchor
  uint32_t* nearest;   ///< row
  uint32_t* measured;  ///< blocks measured since; the number of blocks: no anchor
};

/// The distances with these bounds, and whether their values are squares.
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

/// Returns the bound: rows with a greater value at the anchor now have one greater than `best`.
/// Values of cosine are at most 2, where a clipped row could only tie; the bound is then above 2,
/// and no stored value is.
template <class Metric>
ETLMON_INLINE uint32_t reach_of(uint32_t best, uint32_t moved, uint32_t dimension) noexcept {
  constexpr uint32_t kNothing = 0xffffffffu;
  if (best > kGreatestSquare || moved > kGreatestSquare) return kNothing;
  const float room = 1.0f + (1.25f * static_cast<float>(dimension) + 48.0f) * FLT_EPSILON;
  const float least =
      from_bits(kLeastSquare);  // far above 2^-100: the loss by underflow is below a rounding of it
  const float b = from_bits(best) > least ? from_bits(best) : least;
  const float m = from_bits(moved) > least ? from_bits(moved) : least;
  if constexpr (Reach<Metric>::kSquare) {
    const float root = rounded(square_root(b) + square_root(m)) * room;
    return observe(rounded(root * root));
  } else {
    return observe(rounded(rounded(b + m) * room));
  }
}

/// Returns the limit beyond which a row is not measured to its end while blocks are stored: twice
/// the nearest distance, so that its block can still be skipped after the embedding has moved.
template <class Metric>
ETLMON_INLINE uint32_t room_beyond(uint32_t best) noexcept {
  constexpr uint32_t kTwice = 1u << 23;
  const uint32_t more = Reach<Metric>::kSquare ? 2 * kTwice : kTwice;
  return best < kInfinityBits - more ? best + more : kInfinityBits;
}

}  // namespace detail
}  // namespace ETLMON_BUILD
}  // namespace etlmon
