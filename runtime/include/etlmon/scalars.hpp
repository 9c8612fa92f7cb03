// SPDX-License-Identifier: MIT
// Inputs of a monitor besides embeddings: bools and scalars. Takes: bools, floats. Gives: Flag,
// accept(...), present(...). Keeps true: a default-constructed input is missing; a scalar that is
// not finite, or outside its range, is missing, as decided by its bits.
#pragma once

#include "etlmon/bits.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

namespace detail {

template <class First, class Second>
struct Same {
  static constexpr bool value = false;
};
template <class First>
struct Same<First, First> {
  static constexpr bool value = true;
};
template <bool Condition>
struct If {};
template <>
struct If<true> {
  using type = int;
};
}  // namespace detail

/// A bool that may be missing. Only bool converts to it; an int or a pointer is probably a mistake.
class Flag {
 public:
  constexpr Flag() noexcept = default;
  template <class Type, typename detail::If<detail::Same<Type, bool>::value>::type = 0>
  constexpr Flag(Type etlmon_on) noexcept : state_(etlmon_on ? kOn : kOff) {}

  constexpr bool present() const noexcept { return state_ != kNone; }
  constexpr bool value() const noexcept { return state_ == kOn; }  ///< false if missing

 private:
  static constexpr uint8_t kOff = 0, kOn = 1, kNone = 2;
  uint8_t state_ = kNone;
};

ETLMON_INLINE constexpr bool present(const Flag& x) noexcept { return x.present(); }

/// Returns x, or kMissing unless it is finite.
ETLMON_INLINE float accept(const float& x) noexcept {
  return detail::from_bits(is_finite(x) ? detail::observe(x) : detail::kMissingBits);
}

/// Returns x, or kMissing unless it is finite and in [low, high]. Either bound may be infinite.
ETLMON_INLINE float accept(const float& x, const float& low, const float& high) noexcept {
  constexpr int32_t kMost = static_cast<int32_t>(detail::kInfinityBits) - 1;
  const int32_t from = detail::ordered(detail::observe(low)),
                to = detail::ordered(detail::observe(high));
  const int32_t at = detail::ordered(detail::observe(x));  // a NaN lies beyond the infinities
  const bool inside = (from < -kMost ? -kMost : from) <= at && at <= (to > kMost ? kMost : to);
  return detail::from_bits(inside ? detail::observe(x) : detail::kMissingBits);
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
