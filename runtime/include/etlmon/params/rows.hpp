// SPDX-License-Identifier: MIT
// The distance kernel on the rows of a retargetable class, whose address is known at run time.
// Takes: the arguments of measure() in distance/kernel.hpp, and a pointer to Rows x Dim floats,
// row-major. Gives: the same distances, bit for bit.
#pragma once

#include "etlmon/distance/kernel.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

template <class Metric, class Aggregation, uint32_t Rows, uint32_t Dim>
ETLMON_INLINE Measured measure_rows(const float* z, const float* rows,
                                    const float* weights = nullptr) noexcept {
  return detail::best<Metric, Aggregation, detail::Fixed<Rows, Dim>, false>(detail::unforeseen(z),
                                                                            rows, weights, {}, {});
}

/// Measures a sample of this step, or a point of scalars; unmeasured if it, or one of them, is
/// missing.
template <class Metric, class Aggregation, uint32_t Rows, uint32_t Dim>
ETLMON_INLINE Measured measure_rows(Vector<float, Dim> z, const float* rows,
                                    const float* weights = nullptr) noexcept {
  return z.present() ? measure_rows<Metric, Aggregation, Rows, Dim>(z.data(), rows, weights)
                     : kUnmeasured;
}
template <class Metric, class Aggregation, uint32_t Rows, uint32_t Dim>
ETLMON_INLINE Measured measure_rows(const Point<Dim>& point, const float* rows,
                                    const float* weights = nullptr) noexcept {
  return measure_rows<Metric, Aggregation, Rows, Dim>(point.elements, rows, weights);
}

/// Measures a direction, which several distances may share.
template <class Metric, class Aggregation, uint32_t Rows, uint32_t Dim>
ETLMON_INLINE Measured measure_rows(const Direction<Dim>& z, const float* rows) noexcept {
  static_assert(Metric::kDirection, "this distance does not need the length of z");
  if (z.elements == nullptr) return kUnmeasured;
  return measure_rows<detail::LengthGiven<Metric>, Aggregation, Rows, Dim>(z.elements, rows,
                                                                           &z.inverse_length);
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
