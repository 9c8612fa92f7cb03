// SPDX-License-Identifier: MIT
// Distances whose squares, or sum, leave the range of float32: huge, tiny, or exactly zero. Takes:
// the arguments of kernel.hpp. Gives: distances computed from differences scaled by a power of two,
// row by row. Keeps true: a distance that float32 can represent neither overflows nor vanishes in
// between; a zero vector has no direction. Not inlined; one function for all sizes.
#pragma once

#include "etlmon/distance/best.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {
namespace detail {

ETLMON_INLINE PowerOfTwo power_of_two(uint32_t bits_of_x) noexcept {
  uint32_t exponent = bits_of_x >> 23;
  exponent = exponent < 1 ? 1 : exponent > 253 ? 253 : exponent;
  return {from_bits((254 - exponent) << 23), from_bits(exponent << 23)};
}

template <class Elements>
ETLMON_INLINE uint32_t greatest_magnitude(Elements x, uint32_t n) noexcept {
  uint32_t greatest = 0;
  for (uint32_t i = 0; i < n; ++i) {
    const uint32_t bits = observe(element(x, i)) & ~kSignBit;
    greatest = bits > greatest ? bits : greatest;
  }
  return greatest;
}

/// Computes the bits of |z - g|. Short, here and below: Size::is_short() of the rows.
template <bool Short>
class RescaledL2 {
 public:
  RescaledL2(const float* etlmon_z, const float*, uint32_t etlmon_dimension) noexcept
      : z_(etlmon_z), dimension_(etlmon_dimension) {}
  static constexpr bool known() noexcept { return true; }

  template <class Elements>
  uint32_t row(Elements g) const noexcept {
    const uint32_t greatest =
        observe(baseline::one_row<Linf>({}, z_, g, z_, RowSize<Short>{{1, dimension_}}));
    if (greatest == 0 || greatest >= kInfinityBits) return greatest;
    const PowerOfTwo power = power_of_two(greatest);
    const float square =
        baseline::one_row<ScaledL2Sq>(power, z_, g, z_, RowSize<Short>{{1, dimension_}});
    return observe(rounded(rounded(square_root(square)) * power.up));
  }

 private:
  const float* z_;
  uint32_t dimension_;
};

/// Computes the bits of sqrt((z - g)^T W (z - g)); W a diagonal or full. With s = sqrt(diag W) and
/// a = s (z - g), every |W_ij / (s_i s_j)| <= 1 (W is positive definite), so scaling a by its
/// largest element bounds every term.
template <class Metric>
class RescaledRoot {
 public:
  RescaledRoot(const float* etlmon_z, const float* etlmon_weights,
               uint32_t etlmon_dimension) noexcept
      : z_(etlmon_z), weights_(etlmon_weights), dimension_(etlmon_dimension) {}
  static constexpr bool known() noexcept { return true; }

  template <class Elements>
  uint32_t row(Elements g) const noexcept {
    constexpr uint32_t kQuarterOfMost =
        0x7e800000u;  // 2^126: differences of larger elements may overflow
    const uint32_t size_z = greatest_magnitude(z_, dimension_),
                   size_g = greatest_magnitude(g, dimension_);
    const float half = size_z >= kQuarterOfMost || size_g >= kQuarterOfMost ? 0.5f : 1.0f;

    uint32_t greatest = 0;
    for (uint32_t i = 0; i < dimension_; ++i) {
      const uint32_t bits = observe(rounded(difference(g, i, half) * stretch(i))) & ~kSignBit;
      greatest = bits > greatest ? bits : greatest;
    }
    if (greatest == 0 || greatest >= kInfinityBits) return greatest;

    const PowerOfTwo power = power_of_two(greatest);
    float sum = 0.0f;
    for (uint32_t i = 0; i < dimension_; ++i) {
      const float a = rounded(rounded(difference(g, i, half) * stretch(i)) * power.down);
      sum += a * (Metric::kQuadratic ? weighted(g, i, half, power.down) : a);
    }
    const float square = sum > 0.0f ? sum : 0.0f;
    return observe(rounded(rounded(square_root(square) * power.up) / half));
  }

 private:
  template <class Elements>
  float difference(Elements g, uint32_t i, float half) const noexcept {
    return rounded(rounded(z_[i] * half) - rounded(element(g, i) * half));
  }
  float stretch(uint32_t i) const noexcept {
    return square_root(weights_[Metric::kQuadratic ? static_cast<size_t>(i) * dimension_ + i : i]);
  }
  /// Returns element i of W (z - g) / s_i, scaled.
  template <class Elements>
  float weighted(Elements g, uint32_t i, float half, float down) const noexcept {
    const float* row = weights_ + static_cast<size_t>(i) * dimension_;
    const float s = stretch(i);
    if (!(s > 0.0f)) return 0.0f;
    float sum = 0.0f;
    for (uint32_t j = 0; j < dimension_; ++j) {
      sum += rounded(rounded(row[j] / s) * rounded(difference(g, j, half) * down));
    }
    return sum;
  }

  const float* z_;
  const float* weights_;
  uint32_t dimension_;
};

/// Computes the bits of cosine and angular distance for a z whose squared length is out of range:
/// scales z by a power of two, then to length 1.
template <class Metric>
class RescaledDirection {
 public:
  RescaledDirection(const float* etlmon_z, const float*, uint32_t etlmon_dimension) noexcept
      : z_(etlmon_z), dimension_(etlmon_dimension) {
    const uint32_t greatest = greatest_magnitude(z_, dimension_);
    if (greatest == 0) return;
    down_ = power_of_two(greatest).down;
    float square = 0.0f;
    for (uint32_t i = 0; i < dimension_; ++i) {
      const float x = rounded(z_[i] * down_);
      square += x * x;
    }
    known_ =
        (observe(square) & kInfinityBits) != 0;  // also zero if denormals of z were flushed to zero
    point_.scale = known_ ? 1.0f / square_root(square) : 0.0f;
  }
  bool known() const noexcept { return known_; }

  template <class Elements>
  uint32_t row(Elements g) const noexcept {
    typename Metric::template Partial<float> sums{};
    for (uint32_t i = 0; i < dimension_; ++i) {
      baseline::accumulate(Metric{}, sums, point_, baseline::at(point_, rounded(z_[i] * down_)),
                           element(g, i), 0.0f);
    }
    return observe(Metric::finish(Metric::row(sums)));
  }

 private:
  const float* z_;
  uint32_t dimension_;
  float down_ = 1.0f;
  bool known_ = false;
  UnitPoint point_{};
};

/// Computes the bits of a distance that needs no scaling, except in the mean over rows.
template <class Metric, bool Short>
class Unscaled {
 public:
  Unscaled(const float* etlmon_z, const float*, uint32_t etlmon_dimension) noexcept
      : z_(etlmon_z), dimension_(etlmon_dimension) {}
  static constexpr bool known() noexcept { return true; }
  template <class Elements>
  uint32_t row(Elements g) const noexcept {
    return observe(baseline::one_row<Metric>({}, z_, g, z_, RowSize<Short>{{1, dimension_}}));
  }

 private:
  const float* z_;
  uint32_t dimension_;
};

template <bool First, class IfTrue, class IfFalse>
struct Choose {
  using Type = IfTrue;
};
template <class IfTrue, class IfFalse>
struct Choose<false, IfTrue, IfFalse> {
  using Type = IfFalse;
};
template <class Metric, bool Short>
using RescaledSquare = typename Choose<Metric::kWeighted || Metric::kQuadratic,
                                       RescaledRoot<Metric>, RescaledL2<Short>>::Type;
template <class Metric, bool Short>
using RescaledOrNot = typename Choose<Metric::kRescales, RescaledSquare<Metric, Short>,
                                      Unscaled<Metric, Short>>::Type;
template <class Metric, bool Short>
using Rescaled = typename Choose<Metric::kDirection, RescaledDirection<Metric>,
                                 RescaledOrNot<Metric, Short>>::Type;

template <class Metric, bool Short, class Aggregation, bool InColumns, class Elements>
MeasuredBits measure_rescaled(const float* z, const Set<InColumns, Elements>& set,
                              const float* weights, Aggregation aggregation) noexcept {
  const Rescaled<Metric, Short> distance(z, weights, set.dimension);
  if (!distance.known()) return packed(kUnmeasured);
  Nearest nearest;
  typename Set<InColumns, Elements>::Buffer buffer;
  for (uint32_t row = 0; row < set.rows; ++row) {
    const uint32_t bits = distance.row(set.row(row, buffer));
    nearest.add(bits, row);
    if constexpr (Aggregation::kOfDistances) {
      aggregation.add(
          rounded(from_bits(bits) / static_cast<float>(set.rows)));  // prevents overflow of the sum
    } else {
      aggregation.add(bits);
    }
  }
  if constexpr (Aggregation::kOfDistances) {
    return packed(observe(capped<Metric>(aggregation.result(1))), nearest.row);
  } else {
    return packed(aggregation.result(nearest), nearest.row);
  }
}

/// Returns whether z equals row k of the set.
template <bool Short, bool InColumns, class Elements>
ETLMON_INLINE bool is_row(const float* z, const Set<InColumns, Elements>& set,
                          uint32_t k) noexcept {
  typename Set<InColumns, Elements>::Buffer buffer;
  const auto row = set.row(k, buffer);
  if ((observe(z[0] - element(row, 0)) & ~kSignBit) != 0) return false;  // most rows differ here
  return observe(baseline::one_row<Linf>({}, z, row, z, RowSize<Short>{{1, set.dimension}})) == 0;
}

template <class Metric, class Aggregation, class Size, bool InColumns, class Elements>
MeasuredBits measure_again(const float* z, Elements targets, const float* weights, Size size,
                           Aggregation aggregation) noexcept {
  if (z == nullptr || !all_finite(z, size.dimension())) return packed(kUnmeasured);
  const Set<InColumns, Elements> set{targets, size.rows(), size.dimension(), size.stride()};
  if constexpr (Metric::kRescales && Aggregation::kNearest) {
    for (uint32_t row = 0; row < set.rows; ++row) {
      if (is_row<Size::is_short()>(z, set, row)) return packed({0.0f, row});
    }
  }
  return measure_rescaled<Metric, Size::is_short()>(z, set, weights, aggregation);
}

template <bool Short, bool InColumns, class Elements>
bool is_equal(const float* z, const Set<InColumns, Elements>& set, uint32_t row) noexcept {
  return is_row<Short>(z, set, row);
}

}  // namespace detail
}  // namespace ETLMON_BUILD
}  // namespace etlmon
