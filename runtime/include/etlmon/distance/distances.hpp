// SPDX-License-Identifier: MIT
// The distances: their running sums, and the meaning of a sum over all elements. The term of one
// element is in terms.inc, which is compiled once per instruction set. Gives: a struct per
// distance, which the kernels run over rows. Keeps true: the difference z - g is computed first, so
// a small distance is as exact as the difference; |z|^2 + |g|^2 - 2 z.g is not used. Error bounds:
// error_bounds.hpp. Each struct has
//   Partial<Vec>   the running sums; Vec is a float or a vector of them
//   Point          values computed once from z
//   row(sums)      a row's value, >= 0, ordered as the distance is
//   finish(value)  the distance
//   k...           what it reads, where it is accurate, and its range [0, kHighest]
#pragma once

#include "etlmon/bits.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

namespace detail {

/// Sums of squares below this may have lost terms to underflow (to flush to zero under
/// -ffast-math); they are recomputed in scaled form. 2^-80: the loss of at most 2^20 terms is below
/// one rounding of the sum.
constexpr uint32_t kLeastSquare = 0x17800000u;
/// 2^100: the reciprocal of the root is a normal float.
constexpr uint32_t kGreatestSquare = 0x71800000u;
constexpr uint32_t kGreatest = 0x7f7fffffu;  ///< FLT_MAX

/// Returns atan of a finite float, from the library.
ETLMON_INLINE float arc_tangent(float x) noexcept {
#if defined(__GNUC__)
  return __builtin_atanf(x);
#else
  return atanf(x);
#endif
}

struct NoPoint {};

/// One running sum, or two.
template <class Vec>
struct Sum {
  Vec sum;
};
template <class Vec>
struct TwoSums {
  Vec apart, along;
};

/// The defaults of a distance that is a plain sum over elements.
struct Additive {
  template <class Vec>
  using Partial = Sum<Vec>;
  using Point = NoPoint;
  /// Reads one weight per element.
  static constexpr bool kWeighted = false;
  /// Reads Dim x Dim weights.
  static constexpr bool kQuadratic = false;
  /// Depends only on the direction of z, which is scaled to length 1.
  static constexpr bool kDirection = false;
  /// Takes 1 / |z| in place of weights.
  static constexpr bool kLengthGiven = false;
  /// Its sum is a square: outside [kLeastSquare, FLT_MAX] the scaled form is used.
  static constexpr bool kRescales = false;
  /// The value of a row is its sum.
  static constexpr bool kSum = true;
  static constexpr float kHighest = kInfinite;
  ETLMON_INLINE static float row(const Sum<float>& s) noexcept { return s.sum; }
  ETLMON_INLINE static float finish(float value) noexcept { return value; }
};

/// z times `scale` has length 1.
struct UnitPoint {
  float scale;
};

// Other sums of the kernels.
struct SquaredLength : Additive {};  ///< sum z^2
struct Product : Additive {};        ///< sum x g

/// Powers of two: x * down lies in [1, 2) (in [2^-23, 4) at the ends of the range), and up = 1 /
/// down.
struct PowerOfTwo {
  float down, up;
};
/// Sum of squares of scaled differences.
struct ScaledL2Sq : Additive {
  using Point = PowerOfTwo;
};

}  // namespace detail

/// sum (z - g)^2
struct L2Sq : detail::Additive {};

/// sqrt of sum (z - g)^2
struct L2 : L2Sq {
  static constexpr bool kRescales = true;
  ETLMON_INLINE static float finish(float value) noexcept { return detail::square_root(value); }
};

/// sum |z - g|
struct L1 : detail::Additive {};

/// max |z - g|
struct Linf : detail::Additive {};

/// sqrt of sum w (z - g)^2: Mahalanobis distance with a diagonal inverse covariance.
struct MahalanobisDiagonal : L2 {
  static constexpr bool kWeighted = true;
};

/// sqrt of (z - g)^T W (z - g), W symmetric positive definite, Dim x Dim. Its sum is run.inc's
/// quadratic_form.
struct Mahalanobis : L2 {
  static constexpr bool kQuadratic = true;
};

/// 1 - cos(z, g) for a target of length 1, as |u - g|^2 / 2 with u = z / |z|: exact to rounding for
/// nearly parallel vectors, where 1 - u.g would cancel.
struct Cosine : detail::Additive {
  using Point = detail::UnitPoint;
  static constexpr bool kDirection = true;
  static constexpr bool kSum = false;
  static constexpr float kHighest = 2.0f;
  ETLMON_INLINE static float row(const detail::Sum<float>& s) noexcept {
    const float half = 0.5f * s.sum;
    return half < kHighest ? half : kHighest;
  }
};

/// The angle between z and a target of length 1, in radians, as 2 atan(|u - g| / |u + g|), u = z /
/// |z| (Kahan, "How futile are mindless assessments of roundoff", 2006, section 12): no
/// cancellation near 0 nor near pi.
struct Angular : detail::Additive {
  using Point = detail::UnitPoint;
  static constexpr bool kDirection = true;
  static constexpr bool kSum = false;
  static constexpr float kHighest = 3.14159274f;  // the float32 nearest to pi is above pi
  template <class Vec>
  using Partial = detail::TwoSums<Vec>;
  /// Returns tan^2 of half the angle. If |u + g|^2 is below 2^-60, it is 0 but for rounding, and
  /// the angle is pi.
  ETLMON_INLINE static float row(const detail::TwoSums<float>& p) noexcept {
    constexpr float kLeast = 8.67361738e-19f;
    return p.apart / (p.along > kLeast ? p.along : kLeast);
  }
  ETLMON_INLINE static float finish(float value) noexcept {
    const float angle = 2.0f * detail::arc_tangent(detail::square_root(value));
    return angle < kHighest ? angle : kHighest;
  }
};

namespace detail {
/// Clamps a mean of distances, or an end of an interval around one, that rounding may have carried
/// beyond the greatest distance. The bounds of monitors rely on the range of the distance.
template <class Metric>
ETLMON_INLINE float capped(float distance) noexcept {
  if constexpr (Metric::kHighest <= FLT_MAX) {
    return distance < Metric::kHighest ? distance : Metric::kHighest;
  } else {
    return distance;
  }
}

/// The same distance for a given 1 / |z|.
template <class Metric>
struct LengthGiven : Metric {
  static constexpr bool kLengthGiven = true;
};
}  // namespace detail

}  // namespace ETLMON_BUILD
}  // namespace etlmon
