// SPDX-License-Identifier: MIT
// Arrays of registers, for nested formulas.
#pragma once

#include <stddef.h>

#include "etlmon/temporal/value.hpp"

// Unrolls a loop over registers, which g++ does not do by itself. It saves up to 30 % of a step.
#if defined(__GNUC__) && !defined(__clang__) && !defined(__OPTIMIZE_SIZE__)
#define ETLMON_UNROLL _Pragma("GCC unroll 32")
#else
#define ETLMON_UNROLL
#endif

namespace etlmon {
inline namespace ETLMON_BUILD {

/// Returns the min or max of the elements First to Last, First < Last.
template <size_t First, size_t Last, class Kept, size_t Size>
constexpr auto min_in(const Kept (&values)[Size]) noexcept {
  auto result = min_of(values[First], values[First + 1]);
  for (size_t i = First + 2; i <= Last; ++i) result = min_of(result, values[i]);
  return result;
}
template <size_t First, size_t Last, class Kept, size_t Size>
constexpr auto max_in(const Kept (&values)[Size]) noexcept {
  auto result = max_of(values[First], values[First + 1]);
  for (size_t i = First + 2; i <= Last; ++i) result = max_of(result, values[i]);
  return result;
}

/// Sets every element of an array.
template <class Kept, size_t Size, class Type>
constexpr void fill(Kept (&values)[Size], Type value) noexcept {
  for (Kept& kept : values) kept = value;
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
