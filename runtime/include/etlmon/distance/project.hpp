// SPDX-License-Identifier: MIT
// Points of distances that are projected first: y = A (z - m), by the kernels' own sums. Takes: z
// of D floats, or a view of them; A, R x D row-major; m, D or none. Gives: y, R floats, or nothing
// where z is missing. Keeps true: y is unknown as a whole where an element of z is not finite or
// one of y exceeds FLT_MAX; the order of additions depends on R and D alone, so generated code and
// `etlc run` agree bit for bit on one machine; nothing is allocated. Errors: projection_bound() in
// hosted/error_bounds.hpp.
#pragma once

#include "etlmon/distance/row_values.hpp"
#include "etlmon/views.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

namespace detail {
/// The rows of A times z; nullptr where one of them is not finite.
ETLMON_INLINE const float* products(const float* z, const float* matrix, uint32_t Rows,
                                    uint32_t Dim, float* y) noexcept {
  // With -ffast-math g++ warns of rows of 16 elements in a smaller matrix, in a branch that sizes
  // rule out.
  best_row_values<Product>(unforeseen(z), unforeseen(matrix), nullptr, 0, Rows, Sizes{Rows, Dim},
                           y);
  return finite(y, Rows) ? y : nullptr;
}

ETLMON_INLINE void subtract(const float* z, const float* offset, uint32_t Dim,
                            float* centred) noexcept {
  for (uint32_t i = 0; i < Dim; ++i) centred[i] = z[i] - offset[i];
}
}  // namespace detail

/// A z, in `y`, which it returns; nullptr where it is unknown or z is null.
template <uint32_t Rows, uint32_t Dim>
ETLMON_INLINE const float* project(const float* z, const float* matrix, float (&y)[Rows]) noexcept {
  return z == nullptr ? nullptr : detail::products(z, matrix, Rows, Dim, y);
}

/// A (z - m), likewise.
template <uint32_t Rows, uint32_t Dim>
ETLMON_INLINE const float* project(const float* z, const float* matrix, const float* offset,
                                   float (&y)[Rows]) noexcept {
  if (z == nullptr) return nullptr;
  float centred[Dim];
  detail::subtract(z, offset, Dim, centred);
  return detail::products(centred, matrix, Rows, Dim, y);
}

/// The same for a sample of this step.
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

/// The same for scalars of this step, each NaN where it is missing.
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
