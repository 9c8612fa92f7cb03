// SPDX-License-Identifier: MIT
// Numbers of earlier steps: the number of N steps ago; mean, min and max of the last N. Takes: one
// number a step, NaN where it is missing. Gives: a number, NaN while one of those that it is made
// of is missing or before the first step. Keeps true: constant work a step, whatever N; all
// arithmetic is on integers, so every build gives the same bits. A mean is the exact sum of the N
// numbers, divided by N and rounded once: nothing accumulates. The numbers pass as their bits,
// since clang takes float parameters for numbers under -ffast-math.
#pragma once

#include <stdint.h>

#include "etlmon/past/exact_sum.hpp"
#include "etlmon/temporal/delay.hpp"
#include "etlmon/temporal/value.hpp"
#include "etlmon/temporal/window.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

/// The state of a mean besides its numbers.
struct MeanState {
  detail::ExactSum sum;  ///< of the finite ones
  uint32_t cursor;       ///< slot of the oldest number, and of the next
  uint32_t count;        ///< numbers in the window, none of which is missing
  uint32_t above;        ///< of these: infinities
  uint32_t below;        ///< of these: negative infinities

  constexpr void reset() noexcept {
    sum.reset();
    cursor = count = above = below = 0;
  }

  void change(uint32_t bits, bool take_away) noexcept {
    const uint32_t one = take_away ? ~uint32_t{0} : 1u;
    if (bits == detail::kInfinityBits)
      above += one;
    else if (bits == (detail::kInfinityBits | detail::kSignBit))
      below += one;
    else
      sum.add(bits, take_away);
  }
};

/// Whether bits are those of a NaN.
constexpr bool is_nan_bits(uint32_t bits) noexcept {
  return (bits << 1) > (detail::kInfinityBits << 1);
}

/// Takes a step of a mean of the last n over caller-owned storage of n numbers. Returns the bits of
/// the mean; with infinities of both signs it has none.
ETLMON_STEP uint32_t mean_push(uint32_t* storage, MeanState& state, uint32_t n,
                               uint32_t bits) noexcept {
  if (is_nan_bits(bits)) {  // a window that it is in has no mean
    state.reset();
    return detail::kMissingBits;
  }
  const uint32_t at = state.cursor;
  state.cursor = at + 1 == n ? 0 : at + 1;
  if (state.count == n)
    state.change(storage[at], true);
  else
    ++state.count;
  storage[at] = bits;
  state.change(bits, false);
  if (state.count < n || (state.above != 0 && state.below != 0)) return detail::kMissingBits;
  if (state.above != 0) return detail::kInfinityBits;
  if (state.below != 0) return detail::kInfinityBits | detail::kSignBit;
  return state.sum.divided_by(n);
}

/// Takes a step of a min or max of the last n, over storage as window_push has it. count: numbers
/// since the last missing one, at most n.
template <class Monoid>
inline uint32_t extreme_push(Key* storage, uint32_t& cursor, uint32_t& count, uint32_t n,
                             uint32_t bits) noexcept {
  const bool missing = is_nan_bits(bits);
  const Key key =
      window_push<Monoid>(storage, cursor, n, missing ? Monoid::identity() : detail::ordered(bits));
  count = missing ? 0 : count + (count < n ? 1u : 0u);
  return count == n ? static_cast<uint32_t>(detail::ordered(static_cast<uint32_t>(key)))
                    : detail::kMissingBits;
}

/// The number of Steps steps ago.
template <uint32_t Steps>
class Ago {
 public:
  constexpr void reset() noexcept { bits_.reset(detail::kMissingBits); }
  ETLMON_INLINE float push(const float& x) noexcept {
    return float_of_bits(bits_.push(bits_of(x)));
  }

 private:
  Delay<uint32_t, Steps> bits_;
};

/// The mean of the last Steps numbers.
template <uint32_t Steps>
class MovingMean {
  static_assert(Steps >= 2 && Steps <= detail::kMostNumbers, "the sum holds no more numbers");

 public:
  constexpr void reset() noexcept { state_.reset(); }
  ETLMON_INLINE float push(const float& x) noexcept {
    return float_of_bits(mean_push(bits_, state_, Steps, bits_of(x)));
  }

 private:
  MeanState state_;
  uint32_t bits_[Steps];  ///< written before read
};

/// The min or max of the last Steps numbers.
template <class Monoid, uint32_t Steps>
class MovingExtreme {
  static_assert(Steps >= 2, "of one number it is the number");

 public:
  constexpr void reset() noexcept {
    count_ = 0;
    window_reset<Monoid>(storage_, cursor_, Steps);
  }
  ETLMON_INLINE float push(const float& x) noexcept {
    return float_of_bits(extreme_push<Monoid>(storage_, cursor_, count_, Steps, bits_of(x)));
  }

 private:
  uint32_t cursor_;
  uint32_t count_;
  Key storage_[window_elements(Steps)];
};

template <uint32_t Steps>
using MovingMin = MovingExtreme<Least<Key>, Steps>;
template <uint32_t Steps>
using MovingMax = MovingExtreme<Greatest<Key>, Steps>;

}  // namespace ETLMON_BUILD
}  // namespace etlmon
