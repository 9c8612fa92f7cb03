// SPDX-License-Identifier: MIT
// The distances: what one element adds, and what the sum over all elements means.
// Takes: an embedding z and a target g of D floats, all finite; a weight per element where the distance has weights.
// Gives: per distance a struct that kernel.hpp runs over rows. Keeps true: the difference z - g comes first, always, so
// a small distance is as exact as the difference is; |z|^2 + |g|^2 - 2 z.g decides nothing. Error bounds:
// error_bounds.hpp. Each struct has
//   Partial<V>  running sums, V a Pack or a float      add(to, point, z, g, w)  one element, or four, into them
//   Point       what is computed once from z           combine(a, b)            of two lanes' sums
//   row(sums)   a row's value >= 0, ordered as the     finish(value)            the distance
//               distance is                            k...                     what it reads, where it is sound
#pragma once

#include "etlmon/pack.hpp"

namespace etlmon {

namespace detail {

/// Sums of squares below this may have lost terms to underflow (to flush to zero under -ffast-math); they are computed
/// again in scaled form. 2^-80: what a term of D <= 2^20 can lose is below one rounding of the sum.
constexpr uint32_t kLeastSquare = 0x17800000u;
constexpr uint32_t kGreatestSquare = 0x71800000u;  ///< 2^100: the reciprocal of the root is a normal float
constexpr uint32_t kGreatest = 0x7f7fffffu;        ///< FLT_MAX

struct NoPoint {};

/// One running sum, or two.
template <class V>
struct Sum {
  V sum;
};
template <class V>
struct TwoSums {
  V apart, along;
};
template <uint32_t I>
ETLMON_INLINE Sum<float> lane(const Sum<Pack>& s) noexcept {
  return {lane<I>(s.sum)};
}
template <uint32_t I>
ETLMON_INLINE TwoSums<float> lane(const TwoSums<Pack>& s) noexcept {
  return {lane<I>(s.apart), lane<I>(s.along)};
}

/// A distance that is a plain sum over elements needs no more than its term.
struct Additive {
  template <class V>
  using Partial = Sum<V>;
  using Point = NoPoint;
  static constexpr bool kWeighted = false;   ///< reads one weight per element
  static constexpr bool kQuadratic = false;  ///< reads D x D weights
  static constexpr bool kDirection = false;  ///< of z only the direction counts: z is scaled to length 1
  static constexpr bool kRescales =
      false;  ///< value is a square: outside [kLeastSquare, FLT_MAX] the scaled form decides
  static constexpr bool kTwoRows = true;  ///< the sums of two rows fit in the registers
  template <class V>
  ETLMON_INLINE static Sum<V> combine(const Sum<V>& a, const Sum<V>& b) noexcept {
    return {a.sum + b.sum};
  }
  ETLMON_INLINE static float row(const Sum<float>& s) noexcept { return s.sum; }
  ETLMON_INLINE static float finish(float value) noexcept { return value; }
};

/// z times `scale` has length 1.
struct UnitPoint {
  float scale;
};

/// Rounded here: whether the product is fused with what follows would depend on how many rows share it.
template <class V>
ETLMON_INLINE V unit(UnitPoint point, V z) noexcept {
  return rounded(z * point.scale);
}

}  // namespace detail

/// sum (z - g)^2
struct L2Sq : detail::Additive {
  template <class V>
  ETLMON_INLINE static void add(detail::Sum<V>& to, detail::NoPoint, V z, V g, V) noexcept {
    const V difference = z - g;
    to.sum = to.sum + difference * difference;
  }
};

/// sqrt of sum (z - g)^2
struct L2 : L2Sq {
  static constexpr bool kRescales = true;
  ETLMON_INLINE static float finish(float value) noexcept { return detail::square_root(value); }
};

/// sum |z - g|
struct L1 : detail::Additive {
  template <class V>
  ETLMON_INLINE static void add(detail::Sum<V>& to, detail::NoPoint, V z, V g, V) noexcept {
    to.sum = to.sum + detail::magnitude(z - g);
  }
};

/// max |z - g|
struct Linf : detail::Additive {
  template <class V>
  ETLMON_INLINE static void add(detail::Sum<V>& to, detail::NoPoint, V z, V g, V) noexcept {
    to.sum = detail::larger(detail::magnitude(z - g), to.sum);
  }
  template <class V>
  ETLMON_INLINE static detail::Sum<V> combine(const detail::Sum<V>& a, const detail::Sum<V>& b) noexcept {
    return {detail::larger(a.sum, b.sum)};
  }
};

/// sqrt of sum w (z - g)^2: Mahalanobis distance with a diagonal inverse covariance.
struct MahalanobisDiagonal : L2 {
  static constexpr bool kWeighted = true;
  template <class V>
  ETLMON_INLINE static void add(detail::Sum<V>& to, detail::NoPoint, V z, V g, V w) noexcept {
    const V difference = z - g;
    to.sum = to.sum + (w * difference) * difference;
  }
};

/// sqrt of (z - g)^T W (z - g), W symmetric positive definite, D x D. Its sum is kernel.hpp's quadratic_form.
struct Mahalanobis : L2 {
  static constexpr bool kQuadratic = true;
  static constexpr bool kTwoRows = false;
};

/// 1 - cos(z, g) for a target of length 1, as |u - g|^2 / 2 with u = z / |z|: exact to rounding for nearly parallel
/// vectors, where 1 - u.g would cancel. [0, 2].
struct Cosine : detail::Additive {
  using Point = detail::UnitPoint;
  static constexpr bool kDirection = true;
  template <class V>
  ETLMON_INLINE static void add(detail::Sum<V>& to, Point point, V z, V g, V) noexcept {
    const V difference = detail::unit(point, z) - g;
    to.sum = to.sum + difference * difference;
  }
  ETLMON_INLINE static float row(const detail::Sum<float>& s) noexcept {
    const float half = 0.5f * s.sum;
    return half < 2.0f ? half : 2.0f;
  }
};

/// The angle between z and a target of length 1, in radians, as 2 atan(|u - g| / |u + g|), u = z / |z| (Kahan, "How
/// futile are mindless assessments of roundoff", 2006, section 12): no cancellation near 0 nor near pi. [0, pi].
struct Angular : detail::Additive {
  using Point = detail::UnitPoint;
  static constexpr bool kDirection = true;
  static constexpr bool kTwoRows = false;
  template <class V>
  using Partial = detail::TwoSums<V>;
  template <class V>
  ETLMON_INLINE static void add(detail::TwoSums<V>& to, Point point, V z, V g, V) noexcept {
    const V u = detail::unit(point, z);
    const V difference = u - g;
    const V total = u + g;
    to.apart = to.apart + difference * difference;
    to.along = to.along + total * total;
  }
  template <class V>
  ETLMON_INLINE static detail::TwoSums<V> combine(const detail::TwoSums<V>& a, const detail::TwoSums<V>& b) noexcept {
    return {a.apart + b.apart, a.along + b.along};
  }
  /// tan^2 of half the angle. Below 2^-60, |u + g|^2 is 0 but for rounding, and the angle pi.
  ETLMON_INLINE static float row(const detail::TwoSums<float>& p) noexcept {
    constexpr float kLeast = 8.67361738e-19f;
    return p.apart / (p.along > kLeast ? p.along : kLeast);
  }
  ETLMON_INLINE static float finish(float value) noexcept { return 2.0f * atanf(detail::square_root(value)); }
};

}  // namespace etlmon
