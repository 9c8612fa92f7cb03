// SPDX-License-Identifier: MIT
// The distance between two points of a step, and what points are put together or added from. Takes:
// arrays of floats, null where the point is missing. Gives: the distance by the kernel for one row,
// which is the second point. Keeps true: unmeasured if one of them is missing, or zero under cosine
// or angular; generated code and `etlc run` agree bit for bit on one machine, in sums under any
// flags. Errors: rounding_bound() in hosted/error_bounds.hpp; four times that for cosine and
// angular, whose second point is scaled to length 1 in float32; projection_bound() for sums.
#pragma once

#include "etlmon/distance/rescaled.hpp"
#include "etlmon/distance/row_values.hpp"
#include "etlmon/distance/widen.hpp"
#include "etlmon/views.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

namespace detail {

/// Stores g / |g| in `unit`. Returns false if g has no direction.
inline bool scale_to_unit(const float* g, uint32_t dim, float* unit) noexcept {
  float square = 0.0f;
  best_row_values<SquaredLength>(g, g, nullptr, 0, 1, Sizes{1, dim}, &square);
  float down = 1.0f;
  const uint32_t bits = observe_sum(square);
  if (bits < kLeastSquare || bits > kGreatestSquare) {
    const uint32_t greatest = greatest_magnitude(g, dim);
    if (greatest == 0) return false;
    down = power_of_two(greatest).down;
    square = 0.0f;
    for (uint32_t i = 0; i < dim; ++i) {
      const float x = rounded(g[i] * down);
      square += x * x;
    }
    // also zero if denormals of g were flushed to zero
    if ((observe(square) & kInfinityBits) == 0) return false;
  }
  const float scale = 1.0f / square_root(square);
  for (uint32_t i = 0; i < dim; ++i) unit[i] = rounded(g[i] * down) * scale;
  return true;
}

}  // namespace detail

/// Returns the distance between two points of Dim elements.
template <class Metric, uint32_t Dim>
ETLMON_INLINE Measured measure_between(const float* a, const float* b,
                                       const float* weights = nullptr) noexcept {
  using Size = detail::Fixed<1, Dim>;
  if (a == nullptr || b == nullptr) return kUnmeasured;
  if constexpr (Metric::kDirection) {
    float unit[Dim];
    if (!detail::scale_to_unit(detail::unforeseen(b), Dim, unit)) return kUnmeasured;
    return detail::best<Metric, Min, Size, false>(detail::unforeseen(a),
                                                  static_cast<const float*>(unit), weights, {}, {});
  } else {
    return detail::best<Metric, Min, Size, false>(detail::unforeseen(a), detail::unforeseen(b),
                                                  weights, {}, {});
  }
}

/// Stores the scalars of a point; null if one of them is missing.
template <uint32_t Dim, class... Scalars>
ETLMON_INLINE const float* gathered(float (&to)[Dim], const Scalars&... scalars) noexcept {
  static_assert(sizeof...(Scalars) == Dim, "one number each");
  const float all[] = {scalars...};
  for (uint32_t i = 0; i < Dim; ++i) to[i] = all[i];
  return finite(to, Dim) ? to : nullptr;
}

/// Returns a sample of float16 or int8 in float32, null if it is missing.
template <uint32_t Dim>
ETLMON_INLINE const float* widened(const uint16_t* sample, float (&to)[Dim]) noexcept {
  if (sample == nullptr) return nullptr;
  widen_f16(sample, to, Dim);
  return to;
}
template <uint32_t Dim>
ETLMON_INLINE const float* widened(const int8_t* sample, float scale, float (&to)[Dim]) noexcept {
  if (sample == nullptr) return nullptr;
  widen_i8(sample, scale, to, Dim);
  return to;
}

/// A part of a point: Dim elements, null if it is missing.
template <uint32_t Dim>
struct Part {
  const float* elements;
};

/// Puts parts together, one behind the other; null if one of them is missing.
template <uint32_t Dim, uint32_t... Dims>
ETLMON_INLINE const float* joined(float (&to)[Dim], Part<Dims>... parts) noexcept {
  static_assert((Dims + ...) == Dim, "the dimensions of the parts add up");
  if (((parts.elements == nullptr) || ...)) return nullptr;
  uint32_t at = 0;
  const auto append = [&](const float* etlmon_from, uint32_t etlmon_count) noexcept {
    for (uint32_t i = 0; i < etlmon_count; ++i) to[at + i] = etlmon_from[i];
    at += etlmon_count;
  };
  (append(parts.elements, Dims), ...);
  return to;
}

/// A part of a sum of points, null if it is missing.
struct Term {
  float factor;
  const float* elements;
};

namespace detail {
/// Adds the term. The product rounds once, and so does the sum.
ETLMON_INLINE void add_term(const Term& term, uint32_t dim, float* sum) noexcept {
  for (uint32_t i = 0; i < dim; ++i)
    sum[i] = rounded(sum[i] + rounded(term.factor * term.elements[i]));
}
}  // namespace detail

/// Adds the terms in their order; null if one of them is missing or an element exceeds FLT_MAX.
template <uint32_t Dim, uint32_t Terms>
ETLMON_INLINE const float* summed(float (&to)[Dim], const Term (&terms)[Terms]) noexcept {
  for (const Term& term : terms) {
    if (term.elements == nullptr) return nullptr;
  }
  for (float& element : to) element = 0.0f;
  for (const Term& term : terms) detail::add_term(term, Dim, to);
  return finite(to, Dim) ? to : nullptr;
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
