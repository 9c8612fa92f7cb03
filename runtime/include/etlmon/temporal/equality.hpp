// SPDX-License-Identifier: MIT
// == and != of scalars: true or false, without a margin. Takes: delta (a sample or an expression),
// NaN if unknown; epsilon; the range of the comparison. Gives: +inf or -inf as a value, or a truth
// value; the range if delta is unknown. Keeps true: exact under any compiler flags; -0 equals 0.
#pragma once

#include "etlmon/temporal/truth.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

namespace detail {
/// Compares keys, which are ordered as the numbers are.
ETLMON_INLINE bool same(const float& a, const float& b) noexcept { return key_of(a) == key_of(b); }
}  // namespace detail

ETLMON_INLINE Truth is_equal(const float& delta, const float& epsilon,
                             Truth range = kPerhaps) noexcept {
  return is_nan(delta) ? range : truth_of(detail::same(delta, epsilon));
}
ETLMON_INLINE Truth is_unequal(const float& delta, const float& epsilon,
                               Truth range = kPerhaps) noexcept {
  return is_nan(delta) ? range : truth_of(!detail::same(delta, epsilon));
}

ETLMON_INLINE Value equal(const float& delta, const float& epsilon, Value range) noexcept {
  if (is_nan(delta)) return range;
  return detail::same(delta, epsilon) ? kTrue : kFalse;
}
ETLMON_INLINE Value unequal(const float& delta, const float& epsilon, Value range) noexcept {
  if (is_nan(delta)) return range;
  return detail::same(delta, epsilon) ? kFalse : kTrue;
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
