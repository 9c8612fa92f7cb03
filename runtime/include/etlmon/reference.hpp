// SPDX-License-Identifier: MIT
// Whether the encoder of this machine makes of a reference frame the embedding that calibration
// saw. Takes: the embedding that this machine makes, and a sketch of the other one. Gives: an
// estimate of the length of their difference. Keeps true: it needs no memory for the embedding that
// calibration saw; what is missing or not finite never agrees.
#pragma once

#include "etlmon/views.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

/// A sketch of an embedding r: its length, and 16 sums of its elements, each with its own signs
/// (random projections; Achlioptas, "Database-friendly random projections", 2003).
struct Reference {
  float length;    ///< |r|; 1 where that is 0
  float sums[16];  ///< of sign(k, j) r[j]
};

namespace detail {

/// Returns 32 mixed bits of an index; bit k is the sign of that element in sum k. A bijection,
/// "lowbias32" of github.com/skeeto/hash-prospector.
ETLMON_INLINE constexpr uint32_t signs_of(uint32_t index) noexcept {
  index ^= index >> 16;
  index *= 0x7feb352du;
  index ^= index >> 15;
  index *= 0x846ca68bu;
  return index ^ index >> 16;
}

}  // namespace detail

/// The relative difference of what cannot be compared.
inline constexpr float kNoReference = FLT_MAX;

/// Estimates |z - r| / |r| from the sums, within a third of its value in nearly all cases;
/// kNoReference where z is missing or not finite.
template <size_t Dim>
float difference_from(const Reference& reference, const Vector<float, Dim>& z) noexcept {
  if (!present(z)) return kNoReference;
  float sums[16] = {};
  for (uint32_t j = 0; j < Dim; ++j) {
    const uint32_t signs = detail::signs_of(j);
    for (uint32_t k = 0; k < 16; ++k)
      sums[k] += (signs >> k & 1u) != 0 ? -z.data()[j] : z.data()[j];
  }
  float squares = 0.0f;
  for (uint32_t k = 0; k < 16; ++k) {
    const float relative = (sums[k] - reference.sums[k]) / reference.length;
    squares += relative * relative;
  }
  return is_finite(squares) ? detail::square_root(squares / 16.0f) : kNoReference;
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
