// SPDX-License-Identifier: MIT
// A distance with bounds, measured on a narrow copy of the targets. Takes: the distance from z to
// rows in float16 or int8, and how far narrowing moved a row. Gives: an interval that contains the
// distance to the float32 rows, in real arithmetic and as any build computes it; whether it decides
// a comparison. Keeps true: an interval is never too small, even under -ffast-math, and stays in
// the range of the distance, on which bounds of monitors rely; if it does not decide a comparison,
// or the distance is not finite, doubtful() is true, and the float32 rows have to be measured.
#pragma once

#include "etlmon/distance/aggregate.hpp"
#include "etlmon/distance/distances.hpp"
#include "etlmon/scalars.hpp"
#include "etlmon/temporal/predicate.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

/// The numbers [low, high] at which a comparison may change; a threshold is a single number.
struct Cut {
  float low, high;
  constexpr Cut(float etlmon_at) noexcept : low(etlmon_at), high(etlmon_at) {}
  constexpr Cut(float etlmon_low, float etlmon_high) noexcept
      : low(etlmon_low), high(etlmon_high) {}
};

/// The distance to the float32 rows is in [low, high]; `measured` is reported.
struct Enclosed {
  Measured measured = kUnmeasured;
  float low = kMissing;
  float high = kMissing;

  /// Returns whether some comparison with a number of the cuts might differ on the float32 rows.
  /// The interval is at least a normal number away from the cuts, so that no difference is flushed
  /// to zero.
  template <size_t Count>
  ETLMON_INLINE bool doubtful(const Cut (&cuts)[Count]) const noexcept {
    if (!is_finite(measured.delta) || !is_finite(high)) return true;
    const Key least = key_of(detail::rounded(low - 2.0f * FLT_MIN));
    const Key greatest = key_of(detail::rounded(high + 2.0f * FLT_MIN));
    bool open = false;
    for (const Cut& cut : cuts) open |= key_of(cut.high) >= least && key_of(cut.low) <= greatest;
    return open;
  }
};

/// Returns an exact distance.
ETLMON_INLINE Enclosed exactly(const Measured& measured) noexcept {
  Enclosed exact;
  exact.measured = measured;
  exact.low = exact.high = measured.delta;
  return exact;
}

namespace detail {

/// |computed - exact| <= linear d + root sqrt(d) + constant, for the exact distance d:
/// error_bounds.hpp in float32, with denormals flushed and two roundings of the interval's ends.
struct RoundingError {
  float linear, root, constant;
  ETLMON_INLINE float at(float distance, float its_root) const noexcept {
    return linear * distance + root * its_root + constant;
  }
};

template <class First, class Second>
constexpr bool is() noexcept {
  return Same<First, Second>::value;
}

/// The distances for which rounding_error() and change() are defined.
template <class Metric>
constexpr bool is_bounded() noexcept {
  return is<Metric, L2>() || is<Metric, L2Sq>() || is<Metric, L1>() || is<Metric, Linf>() ||
         is<Metric, Cosine>() || is<Metric, Angular>() || is<Metric, MahalanobisDiagonal>();
}

template <class Metric>
constexpr RoundingError rounding_error(uint32_t dimension) noexcept {
  const float d = static_cast<float>(dimension);
  const float lost = (d + 4.0f) * FLT_MIN;
  if (is<Metric, Linf>()) return {3.0f * FLT_EPSILON, 0.0f, lost};
  if (is<Metric, L1>()) return {(0.5f * d + 3.0f) * FLT_EPSILON, 0.0f, lost};
  if (is<Metric, L2Sq>()) return {(0.5f * d + 5.0f) * FLT_EPSILON, 0.0f, lost};
  if (is<Metric, Cosine>()) {
    const float length = (0.25f * d + 5.0f) * FLT_EPSILON;
    return {(0.75f * d + 10.0f) * FLT_EPSILON, 1.5f * FLT_EPSILON, 0.5f * length * length + lost};
  }
  if (is<Metric, Angular>()) return {2.0f * FLT_EPSILON, 0.0f, (0.75f * d + 16.0f) * FLT_EPSILON};
  return {(0.25f * d + 7.0f) * FLT_EPSILON, 0.0f, lost};  // l2 and mahalanobis, diagonal
}

/// Returns how much a distance d changes if a row moves by `moved`, in the norm of the distance,
/// for l2sq, cosine and angular in the Euclidean norm. By the triangle inequality; of squares, |a^2
/// - b^2| = |a - b| (a + b); cosine is half the square of a chord. Angular is f = 2 atan(a / b)
/// with a = |u - g|, b = |u + g|, |u| = 1: neither a nor b changes faster than g moves, so |df| = 2
/// |b da - a db| / (a^2 + b^2) <= 2 sqrt(2) / sqrt(a^2 + b^2) |dg|, and a^2 + b^2 = 2 + 2 |g|^2 >=
/// 2 + 2 (1 - moved)^2 all the way from a g of length 1: at most 2 / sqrt(1 + (3/4)^2) = 1.6 times
/// the move of g up to 1/4; beyond, there is no bound.  Rounding leaves u with a length off by s <=
/// (D / 4 + 5) FLT_EPSILON. An angle changes by 2 s |g| / (1 + |g|^2) at most, no more than for |g|
/// = 1. |u - g|^2 / 2 changes by s (d + (1 - |g|^2) / 2): for rows of other lengths, length_error()
/// is added to cosine's bound.
template <class Metric>
ETLMON_INLINE float length_error(float moved, uint32_t dimension) noexcept {
  if (!is<Metric, Cosine>()) return 0.0f;
  return moved * (1.0f + 0.5f * moved) * (0.25f * static_cast<float>(dimension) + 5.0f) *
         FLT_EPSILON;
}
template <class Metric>
ETLMON_INLINE float change(float moved, float its_root) noexcept {
  if (is<Metric, L2Sq>()) return moved * (2.0f * its_root + moved);
  if (is<Metric, Cosine>()) return moved * (1.41421366f * its_root + 0.5f * moved);
  if (is<Metric, Angular>()) return moved <= 0.25f ? 1.6f * moved : 4.0f;
  return moved;
}

}  // namespace detail

/// Returns the bounds that `narrow` gives, measured on rows of which none moved by more than
/// `moved`. `dimension` of the rows; `averaged`: number of rows of a mean, 0 for other
/// aggregations. (All are monotonic in every row's distance, and the bounds are concave in it, so a
/// bound for rows is one for the aggregate.)
template <class Metric>
ETLMON_INLINE Enclosed enclose(const Measured& narrow, float moved, uint32_t dimension,
                               uint32_t averaged = 0) noexcept {
  static_assert(!Metric::kQuadratic,
                "what rounding does to a full quadratic form depends on the point");
  static_assert(detail::is_bounded<Metric>(),
                "rounding_error() and change() have to say how far this distance may be off");
  constexpr float kSlack =
      1.0001f;  // covers the arithmetic below, each operation within 4 roundings
  Enclosed result;
  result.measured = narrow;
  // Nothing below may overflow, which is undefined under -ffast-math.
  constexpr float kGreatestDelta = 1.3e36f, kGreatestMove = 1.1e18f;
  if (!is_finite(narrow.delta) || narrow.delta > kGreatestDelta || moved > kGreatestMove)
    return result;
  detail::RoundingError error = detail::rounding_error<Metric>(dimension);
  error.constant += detail::length_error<Metric>(moved, dimension);
  if (averaged > 0) {
    error.linear += (0.5f * static_cast<float>(averaged) + 3.0f) * FLT_EPSILON;
    error.constant += static_cast<float>(averaged) * FLT_MIN;
  }
  if (!(error.linear < 0.5f)) return result;
  const float rest = 1.0f / (1.0f - error.linear);
  // The exact distance to the narrow rows is at most `distance`, the solution of d - error(d) =
  // delta.
  float root = 0.0f, distance = (narrow.delta + error.constant) * rest;
  if (detail::is<Metric, Cosine>() || detail::is<Metric, L2Sq>()) {
    root = (detail::square_root(narrow.delta + error.constant) + error.root) * rest;
    distance = root * root;
  }
  const float changed = detail::change<Metric>(moved, root);
  float root_there = 0.0f;
  if (detail::is<Metric, Cosine>()) root_there = detail::square_root(distance + changed);
  const float off = detail::rounded(
      (changed + error.at(distance, root) + error.at(distance + changed, root_there)) * kSlack);
  result.low = detail::rounded(narrow.delta - off);
  if (!(key_of(result.low) > 0)) result.low = 0.0f;
  result.high = detail::capped<Metric>(detail::rounded(narrow.delta + off));
  return result;
}

/// Returns the robustness of delta <= epsilon and delta < epsilon, over the interval of delta.
ETLMON_INLINE Value at_most(const Enclosed& delta, const float& epsilon, Value range) noexcept {
  if (is_nan(delta.measured.delta)) return range;
  return between(detail::rounded(epsilon - delta.high), detail::rounded(epsilon - delta.low));
}

/// Returns the robustness of delta >= epsilon and delta > epsilon, over the interval of delta.
ETLMON_INLINE Value at_least(const Enclosed& delta, const float& epsilon, Value range) noexcept {
  if (is_nan(delta.measured.delta)) return range;
  return between(detail::rounded(delta.low - epsilon), detail::rounded(delta.high - epsilon));
}

// The same of two thresholds.
ETLMON_INLINE Value at_most(const Enclosed& delta, const float& inner, const float& outer,
                            Value range) noexcept {
  if (is_nan(delta.measured.delta)) return range;
  return {detail::up_to(inner, delta.high), detail::up_to(outer, delta.low)};
}
ETLMON_INLINE Value at_least(const Enclosed& delta, const float& inner, const float& outer,
                             Value range) noexcept {
  if (is_nan(delta.measured.delta)) return range;
  return {-detail::up_to(inner, delta.low), -detail::up_to(outer, delta.high)};
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
