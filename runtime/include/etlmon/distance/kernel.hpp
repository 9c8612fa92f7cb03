// SPDX-License-Identifier: MIT
// The distance kernel: one embedding against K targets, aggregated.
// Takes: z of D floats; targets K x D row-major, prepared as distances.def says (unit rows for
// cosine and angular); weights D x D or D where the distance has some. Gives: the aggregated
// distance and the nearest row. Keeps true: the order of additions depends on K and D alone, not on
// what is known at compile time, so generated code and `etlc run` agree bit for bit on one machine;
// nothing is allocated; the time depends on the data only where a sum of squares leaves [2^-80,
// FLT_MAX] and the scaled form (rescaled.hpp) decides.
#pragma once

#include "etlmon/distance/best.hpp"
#include "etlmon/distance/rescaled.hpp"
#include "etlmon/views.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {
namespace detail {

/// Weights as the kernels take them: none, D (MahalanobisDiagonal) or D x D symmetric positive
/// definite (Mahalanobis).
template <class Metric, uint32_t Dim>
constexpr uint32_t weights_of() noexcept {
  return Metric::kQuadratic ? Dim * Dim : Metric::kWeighted ? Dim : 0;
}

/// A set that is a constant of the program, as the machine likes it best.
template <class Metric, uint32_t Rows, uint32_t Dim, const auto& Targets>
struct LaidOut {
  static_assert(sizeof(Targets) / sizeof(Targets[0]) == Rows * Dim, "K rows of Dim elements");
  static constexpr bool kInColumns = in_columns(Rows, Dim) && !Metric::kQuadratic;
  static constexpr const auto* values() noexcept {
    if constexpr (kInColumns) {
      return &ColumnsOf<Rows, Dim, Targets>::kColumns.values[0];
    } else {
      return &Targets[0];
    }
  }
};

}  // namespace detail

/// The aggregated distance from z, of D elements, to K targets: for generated code, whose sizes and
/// targets are constants; the compiler lays the targets out as the machine likes them best. Errors:
/// none; delta is NaN where an element of z is not finite and where z is zero under cosine and
/// angular, +inf where it, or for the mean one of the distances, exceeds FLT_MAX; distances that do
/// are taken for equal. Targets may be float32, or float16 as their bits, which are widened as they
/// are read: the same distances.
template <class Metric, class Aggregation, uint32_t Rows, uint32_t Dim, const auto& Targets>
ETLMON_INLINE Measured measure(const float* z, const float* weights = nullptr) noexcept {
  using Layout = detail::LaidOut<Metric, Rows, Dim, Targets>;
  return detail::best<Metric, Aggregation, detail::Fixed<Rows, Dim>, Layout::kInColumns>(
      detail::unforeseen(z), Layout::values(), weights, {}, {});
}

namespace detail {
/// The same, or unmeasured where z is missing, which is left to what has the rare cases: the least
/// code.
template <class Metric, class Aggregation, uint32_t Rows, uint32_t Dim, const auto& Targets>
ETLMON_INLINE Measured measure_unless_missing(const float* z, const float* weights) noexcept {
  using Layout = LaidOut<Metric, Rows, Dim, Targets>;
  using Size = Fixed<Rows, Dim>;
  constexpr bool kInColumns = Layout::kInColumns;
  const auto* rows = Layout::values();
  return unpacked(z == nullptr ? measure_again<Metric, Aggregation, Size, kInColumns>(
                                     z, rows, weights, Size{}, Aggregation{})
                               : packed(best<Metric, Aggregation, Size, kInColumns>(
                                     z, rows, weights, Size{}, Aggregation{})));
}
}  // namespace detail

/// The same for a sample of this step, or a point made of some: unmeasured where it, or one of
/// them, is missing.
template <class Metric, class Aggregation, uint32_t Rows, uint32_t Dim, const auto& Targets>
ETLMON_INLINE Measured measure(Vector<float, Dim> z, const float* weights = nullptr) noexcept {
#if defined(__OPTIMIZE_SIZE__)
  return detail::measure_unless_missing<Metric, Aggregation, Rows, Dim, Targets>(
      detail::unforeseen(z.data()), weights);
#else
  return z.present() ? measure<Metric, Aggregation, Rows, Dim, Targets>(z.data(), weights)
                     : kUnmeasured;
#endif
}
template <class Metric, class Aggregation, uint32_t Rows, uint32_t Dim, const auto& Targets>
ETLMON_INLINE Measured measure(const Point<Dim>& point, const float* weights = nullptr) noexcept {
  return measure<Metric, Aggregation, Rows, Dim, Targets>(point.elements, weights);
}

/// An embedding and 1 / |z|, for the distances to it under which only the direction of z counts.
template <uint32_t Dim>
struct Direction {
  const float* elements;  ///< null where the sample is missing
  float inverse_length;   ///< 0 where it is not known from the sum of squares, which the kernels
                          ///< look into
};

/// The direction of an embedding, found once for several distances.
template <size_t Dim>
ETLMON_INLINE Direction<Dim> direction_of(Vector<float, Dim> z) noexcept {
  const float* elements = detail::unforeseen(z.data());
  return {elements,
          z.present() ? detail::best_inverse_length<detail::Fixed<1, Dim>>(elements) : 0.0f};
}

/// The same, bit for bit, as for the embedding; cosine and angular only.
template <class Metric, class Aggregation, uint32_t Rows, uint32_t Dim, const auto& Targets>
ETLMON_INLINE Measured measure(const Direction<Dim>& z) noexcept {
  static_assert(Metric::kDirection, "this distance does not need the length of z");
  if (z.elements == nullptr) return kUnmeasured;
  return measure<detail::LengthGiven<Metric>, Aggregation, Rows, Dim, Targets>(z.elements,
                                                                               &z.inverse_length);
}

/// The same for targets of int8, each worth `scale` times itself, rounded once.
template <class Metric, class Aggregation, uint32_t Rows, uint32_t Dim, const auto& Targets>
ETLMON_INLINE Measured measure_scaled(const float* z, float scale,
                                      const float* weights = nullptr) noexcept {
  using Layout = detail::LaidOut<Metric, Rows, Dim, Targets>;
  const detail::ScaledRows rows{Layout::values(), scale};
  return detail::best<Metric, Aggregation, detail::Fixed<Rows, Dim>, Layout::kInColumns>(
      z, rows, weights, {}, {});
}

/// The same, bit for bit, for targets that are not constants.
template <class Metric, class Aggregation, uint32_t Rows, uint32_t Dim>
ETLMON_INLINE Measured measure(const float* z, const float (&targets)[Rows * Dim]) noexcept {
  static_assert(!Metric::kWeighted && !Metric::kQuadratic, "this distance needs weights");
  return detail::best<Metric, Aggregation, detail::Fixed<Rows, Dim>, false>(z, &targets[0], nullptr,
                                                                            {}, {});
}

/// The same for distances with weights: D x D symmetric positive definite (Mahalanobis) or D
/// positive (MahalanobisDiagonal).
template <class Metric, class Aggregation, uint32_t Rows, uint32_t Dim>
ETLMON_INLINE Measured
measure(const float* z, const float (&targets)[Rows * Dim],
        const float (&weights)[Metric::kQuadratic ? Dim * Dim : Dim]) noexcept {
  static_assert(Metric::kWeighted || Metric::kQuadratic, "this distance has no weights");
  return detail::best<Metric, Aggregation, detail::Fixed<Rows, Dim>, false>(z, &targets[0], weights,
                                                                            {}, {});
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
