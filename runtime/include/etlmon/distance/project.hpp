// SPDX-License-Identifier: MIT
// Projection of points before their distances: y = A (z - m), with the sums of the kernels. Takes:
// z of Dim floats, or a view of them; A, Rows x Dim, row-major; m, Dim floats or none. Gives: y,
// Rows floats, or nothing if z is missing. Keeps true: all of y is unknown if an element of z is
// not finite or one of y exceeds FLT_MAX; the order of additions depends only on Rows and Dim, so
// generated code and `etlc run` agree bit for bit on one machine; nothing is allocated. Errors:
// projection_bound() in hosted/error_bounds.hpp.
#pragma once

#include "etlmon/distance/row_values.hpp"
#include "etlmon/views.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

namespace detail {
/// Computes A z. Returns nullptr if an element of it is not finite.
ETLMON_INLINE const float* products(const float* z, const float* matrix, uint32_t Rows,
                                    uint32_t Dim, float* y) noexcept {
  // With -ffast-math g++ warns of rows of 16 elements in a smaller matrix, and of more of them than
  // there are, in branches that are not reached.
  best_row_values<Product>(unforeseen(z), unforeseen(matrix), nullptr, 0, Rows, Sizes{Rows, Dim},
                           const_cast<float*>(unforeseen(y)));
  return finite(y, Rows) ? y : nullptr;
}

ETLMON_INLINE void subtract(const float* z, const float* offset, uint32_t Dim,
                            float* centred) noexcept {
  for (uint32_t i = 0; i < Dim; ++i) centred[i] = z[i] - offset[i];
}
}  // namespace detail

/// Stores A z in `y`, and returns it; nullptr if it is unknown or z is null.
template <uint32_t Rows, uint32_t Dim>
ETLMON_INLINE const float* project(const float* z, const float* matrix, float (&y)[Rows]) noexcept {
  return z == nullptr ? nullptr : detail::products(z, matrix, Rows, Dim, y);
}

/// Stores A (z - m) likewise.
template <uint32_t Rows, uint32_t Dim>
ETLMON_INLINE const float* project(const float* z, const float* matrix, const float* offset,
                                   float (&y)[Rows]) noexcept {
  if (z == nullptr) return nullptr;
  float centred[Dim];
  detail::subtract(z, offset, Dim, centred);
  return detail::products(centred, matrix, Rows, Dim, y);
}

/// Projects a sample of this step.
template <uint32_t Rows, uint32_t Dim>
ETLMON_INLINE const float* project(Vector<float, Dim> z, const float* matrix,
                                   float (&y)[Rows]) noexcept {
  return project<Rows, Dim>(z.data(), matrix, y);
}
template <uint32_t Rows, uint32_t Dim>
ETLMON_INLINE const float* project(Vector<float, Dim> z, const float* matrix, const float* offset,
                                   float (&y)[Rows]) noexcept {
  return project<Rows, Dim>(z.data(), matrix, offset, y);
}

/// Projects scalars of this step, each NaN if missing.
template <uint32_t Rows, uint32_t Dim>
ETLMON_INLINE const float* project(const Point<Dim>& z, const float* matrix,
                                   float (&y)[Rows]) noexcept {
  return project<Rows, Dim>(z.elements, matrix, y);
}
template <uint32_t Rows, uint32_t Dim>
ETLMON_INLINE const float* project(const Point<Dim>& z, const float* matrix, const float* offset,
                                   float (&y)[Rows]) noexcept {
  return project<Rows, Dim>(z.elements, matrix, offset, y);
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
