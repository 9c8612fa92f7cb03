// SPDX-License-Identifier: MIT
// Bounds on the error of computed distances, which calibration adds to scores, and tests check
// kernels against. Takes: a distance of distances.def, the dimension D, the exact distance. Gives:
// the largest |computed - exact| for any compiler and CPU that adds in any order, with or without
// fusing, and computes reciprocals and roots to 2 units in the last place. Exact: real arithmetic
// on the given float32 embedding, targets (before prepare()) and weights. Keeps true: no bound is
// below the true error; D <= 2^20. In the comments u = FLT_EPSILON / 2 is one rounding. In double
// arithmetic, for hosts; not part of generated headers.
#pragma once

#include <math.h>

#include "etlmon/hosted/table.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

/// Returns whether denormal numbers are flushed to zero, as -ffast-math does on some hosts at
/// start-up.
enum class Denormals : uint8_t { kept, flushed };

/// Returns the bound on |computed - exact| for one row. `magnitude`, only for mahalanobis: sum over
/// i, j of |d_i| |W_ij| |d_j|, d = z - g.
inline double rounding_bound(MetricId metric, uint32_t D, double exact, double magnitude = 0,
                             Denormals denormals = Denormals::flushed) noexcept {
  constexpr double eps = static_cast<double>(FLT_EPSILON);
  constexpr double kLeastDenormal = 1.401298464324817e-45;
  const double d = D;
  const double lost =
      d * (denormals == Denormals::flushed ? static_cast<double>(FLT_MIN) : kLeastDenormal);
  switch (metric) {
    case MetricId::l1:  // one rounding a difference, at most D - 1 additions
      return (d / 2 + 1) * eps * exact + lost;
    case MetricId::linf:
      return eps * exact + lost;
    case MetricId::l2sq:  // two u from each difference, one from its square, D + 1 from additions
      return (d / 2 + 3) * eps * exact + lost;
    case MetricId::l2:  // half of the above, and the root
      return (d / 4 + 4) * eps * exact + lost;
    case MetricId::mahalanobis_diagonal:  // one more product
      return (d / 4 + 5) * eps * exact + lost;
    case MetricId::mahalanobis: {
      // |sqrt a - sqrt b| is at most |a - b| / sqrt b and at most sqrt |a - b|.
      const double square = (d + 8) * eps * magnitude;
      const double root = sqrt(square);
      return (exact > root ? square / exact : root) + 4 * eps * exact + lost;
    }
    case MetricId::cosine: {
      // z / |z| has a length off by s <= (D / 4 + 3) eps, both unit vectors have elements off by u,
      // relatively: |u' - v'| <= sqrt(s^2 + (1 + s) 2 exact) + eps.
      const double length = (d / 4 + 5) * eps;
      return (0.75 * d + 8) * eps * exact + 1.5 * eps * sqrt(exact) + 0.5 * length * length + lost;
    }
    case MetricId::angular:  // the same s moves the angle by at most s, the sums by sin(angle) (D +
                             // 3) u
      return (0.75 * d + 16) * eps;
  }
  return 0;
}

/// Returns the bound on |computed - exact| of element i of A (z - m) in project.hpp. `magnitude`:
/// sum over j of |A_ij| |z_j - m_j|; `size`: sum over j of |A_ij| + |z_j - m_j|, for flushed
/// denormals.
inline double projection_bound(uint32_t D, double magnitude, double size,
                               Denormals denormals = Denormals::flushed) noexcept {
  constexpr double kLeastDenormal = 1.401298464324817e-45;
  const double lost =
      denormals == Denormals::flushed ? static_cast<double>(FLT_MIN) : kLeastDenormal;
  const double d = D;
  // u from the difference, one from the product, D - 1 from additions
  return (d / 2 + 2) * static_cast<double>(FLT_EPSILON) * magnitude + 2 * (d + size) * lost;
}

/// Returns the error that a mean over K rows adds to the mean of their bounds.
inline double mean_bound(uint32_t K, double exact,
                         Denormals denormals = Denormals::flushed) noexcept {
  constexpr double kLeastDenormal = 1.401298464324817e-45;
  const double k = K;
  return (k / 2 + 3) * static_cast<double>(FLT_EPSILON) * exact +
         k * (denormals == Denormals::flushed ? static_cast<double>(FLT_MIN) : kLeastDenormal);
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
