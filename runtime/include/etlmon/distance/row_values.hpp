// SPDX-License-Identifier: MIT
// The values of rows, by the best version of the kernel, with sizes known at run time. Gives:
// best_row_values(...). Keeps true: the order of additions is that of layout.hpp, so a row has the
// same value as in measure(...).
#pragma once

#include "etlmon/distance/best.hpp"

#if !defined(ETLMON_VECTORS)
namespace etlmon {
inline namespace ETLMON_BUILD {
namespace detail {

#define ETLMON_TARGET
#define ETLMON_WIDE ETLMON_INLINE
namespace baseline {
// clang-format off
#include "etlmon/distance/row_values.inc"
// clang-format on
}  // namespace baseline
#undef ETLMON_WIDE
#undef ETLMON_TARGET

template <class Metric, class Elements>
bool best_row_values(const float* z, Elements targets, const float* weights, uint32_t row,
                     uint32_t end, Sizes size, float* values) noexcept {
  return baseline::row_values<Metric>(z, targets, weights, row, end, size, values);
}

}  // namespace detail
}  // namespace ETLMON_BUILD
}  // namespace etlmon
#endif
