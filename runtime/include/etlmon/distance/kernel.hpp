// SPDX-License-Identifier: MIT
// The distance kernel: the aggregated distance from an embedding to a target set. Takes: z of Dim
// floats; targets Rows x Dim, row-major, prepared as in distances.def (unit rows for cosine and
// angular); weights Dim x Dim or Dim, if the distance has some. Gives: the aggregated distance and
// the nearest row. Keeps true: the order of additions depends only on Rows and Dim, not on what is
// known at compile time, so generated code and `etlc run` agree bit for bit on one machine; nothing
// is allocated; the time depends on the data only if a sum of squares leaves [2^-80, FLT_MAX] and
// the scaled form (rescaled.hpp) is used.
#pragma once

#include "etlmon/distance/best.hpp"
#include "etlmon/distance/rescaled.hpp"
#include "etlmon/views.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {
namespace detail {

/// Returns the number of weights: none, Dim (MahalanobisDiagonal), or Dim x Dim, symmetric positive
/// definite (Mahalanobis).
template <class Metric, uint32_t Dim>
constexpr uint32_t weights_of() noexcept {
  return Metric::kQuadratic ? Dim * Dim : Metric::kWeighted ? Dim : 0;
}

/// A constant target set in the layout that is fastest on the machine.
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

/// Returns the aggregated distance from z, of Dim elements, to Rows targets. For generated code,
/// whose sizes and targets are constants, which the compiler lays out for the machine. Errors:
/// none; delta is NaN if an element of z is not finite, or z is zero under cosine or angular; +inf
/// if it, or for the mean one of the distances, exceeds FLT_MAX; such distances count as equal.
/// Targets may be float32, or the bits of float16, with the same distances.
template <class Metric, class Aggregation, uint32_t Rows, uint32_t Dim, const auto& Targets>
ETLMON_INLINE Measured measure(const float* z, const float* weights = nullptr) noexcept {
  using Layout = detail::LaidOut<Metric, Rows, Dim, Targets>;
  return detail::best<Metric, Aggregation, detail::Fixed<Rows, Dim>, Layout::kInColumns>(
      detail::unforeseen(z), Layout::values(), weights, {}, {});
}

namespace detail {
/// Measures, or returns unmeasured if z is missing. The function for rare cases handles that, for
/// the least code.
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

/// Measures a sample of this step, or a point of scalars; unmeasured if it, or one of them, is
/// missing.
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

/// An embedding and 1 / |z|, for distances that depend only on the direction of z.
template <uint32_t Dim>
struct Direction {
  const float* elements;  ///< null if the sample is missing
  float inverse_length;   ///< 0 if unknown from the sum of squares; the kernels then find it
};

/// Returns the direction of an embedding, for several distances.
template <size_t Dim>
ETLMON_INLINE Direction<Dim> direction_of(Vector<float, Dim> z) noexcept {
  const float* elements = detail::unforeseen(z.data());
  return {elements,
          z.present() ? detail::best_inverse_length<detail::Fixed<1, Dim>>(elements) : 0.0f};
}

/// Measures a direction, with the same bits as for the embedding; cosine and angular only.
template <class Metric, class Aggregation, uint32_t Rows, uint32_t Dim, const auto& Targets>
ETLMON_INLINE Measured measure(const Direction<Dim>& z) noexcept {
  static_assert(Metric::kDirection, "this distance does not need the length of z");
  if (z.elements == nullptr) return kUnmeasured;
  return measure<detail::LengthGiven<Metric>, Aggregation, Rows, Dim, Targets>(z.elements,
                                                                               &z.inverse_length);
}

/// Measures targets of int8, each times `scale`, rounded once.
template <class Metric, class Aggregation, uint32_t Rows, uint32_t Dim, const auto& Targets>
ETLMON_INLINE Measured measure_scaled(const float* z, float scale,
                                      const float* weights = nullptr) noexcept {
  using Layout = detail::LaidOut<Metric, Rows, Dim, Targets>;
  const detail::ScaledRows rows{Layout::values(), scale};
  return detail::best<Metric, Aggregation, detail::Fixed<Rows, Dim>, Layout::kInColumns>(
      z, rows, weights, {}, {});
}

/// Measures targets that are not constants, with the same bits.
template <class Metric, class Aggregation, uint32_t Rows, uint32_t Dim>
ETLMON_INLINE Measured measure(const float* z, const float (&targets)[Rows * Dim]) noexcept {
  static_assert(!Metric::kWeighted && !Metric::kQuadratic, "this distance needs weights");
  return detail::best<Metric, Aggregation, detail::Fixed<Rows, Dim>, false>(z, &targets[0], nullptr,
                                                                            {}, {});
}

/// Measures a distance with weights: Dim x Dim, symmetric positive definite (Mahalanobis), or Dim,
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
