// SPDX-License-Identifier: MIT
// Numbers of earlier steps: the number of N steps ago; mean, min and max of the last N. Takes: one
// number a step, NaN where it is missing. Gives: a number, NaN while one of those that it is made
// of is missing or before the first step. Keeps true: constant work a step, whatever N; all
// arithmetic is on integers, so every build gives the same bits. A mean is the exact sum of the N
// numbers, divided by N and rounded once: nothing accumulates. The numbers pass as their bits,
// since clang takes float parameters for numbers under -ffast-math.
#pragma once

#include <stdint.h>

#include "etlmon/temporal/delay.hpp"
#include "etlmon/temporal/value.hpp"
#include "etlmon/temporal/window.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {
namespace detail {

/// A sum of at most 2^31 finite floats, without rounding: a two's complement number in units of
/// 2^-149, the least float.
class ExactSum {
 public:
  constexpr void reset() noexcept {
    for (uint32_t& word : words_) word = 0;
  }

  /// Adds a finite float, or takes one away that was added before.
  void add(uint32_t bits, bool take_away) noexcept {
    const uint32_t exponent = (bits >> kFraction) & 0xffu, fraction = bits & (kOne - 1);
    const uint32_t shift = exponent == 0 ? 0 : exponent - 1;
    const uint64_t part = uint64_t{exponent == 0 ? fraction : fraction | kOne} << (shift % 32);
    const bool negative = ((bits & kSignBit) != 0) != take_away;
    uint32_t at = shift / 32;
    uint64_t rest = change(at, static_cast<uint32_t>(part), 0, negative);
    rest = change(++at, static_cast<uint32_t>(part >> 32), rest, negative);
    while (rest != 0 && ++at < kWords) rest = change(at, 0, rest, negative);
  }

  /// Returns the bits of the sum divided by n, rounded to the nearest float, ties to even.
  uint32_t divided_by(uint32_t n) const noexcept {
    const bool negative = (words_[kWords - 1] & kSignBit) != 0;
    uint32_t size[kWords];
    uint64_t carry = negative ? 1 : 0;
    for (uint32_t i = 0; i < kWords; ++i) {
      carry += negative ? ~words_[i] : words_[i];
      size[i] = static_cast<uint32_t>(carry);
      carry >>= 32;
    }
    uint32_t top = kWords - 1;
    while (top > 2 && size[top] == 0) --top;
    bool inexact = false;
    for (uint32_t i = 0; i + 2 < top; ++i) inexact = size[i] != 0 || inexact;
    uint64_t rest = 0;
    uint32_t quotient[3];  // from the top: at least 33 bits unless these are all words
    for (uint32_t i = 0; i < 3; ++i) {
      rest = (rest << 32) | size[top - i];
      quotient[i] = static_cast<uint32_t>(rest / n);
      rest %= n;
    }
    const bool wide = quotient[0] != 0;
    const uint64_t value = wide ? (uint64_t{quotient[0]} << 32) | quotient[1]
                                : (uint64_t{quotient[1]} << 32) | quotient[2];
    inexact = (wide && quotient[2] != 0) || rest != 0 || inexact;
    const uint32_t unit = (top - 2) * 32 + (wide ? 32 : 0);
    const uint32_t bits =
        unit == 0 && value < 2 * kOne ? least(value, rest, n) : nearest(value, unit, inexact);
    return negative ? bits | kSignBit : bits;
  }

 private:
  static constexpr uint32_t kFraction = 23;          // bits
  static constexpr uint32_t kOne = 1u << kFraction;  // the bit that normal floats do not store
  static constexpr uint32_t kWords = 10;             // 277 bits of a float, 31 of N, and a sign

  /// Adds to a word, or subtracts from it. Returns what the next word has to take over.
  uint64_t change(uint32_t at, uint32_t part, uint64_t rest, bool negative) noexcept {
    const uint64_t word = words_[at];
    const uint64_t changed = negative ? word - part - rest : word + part + rest;
    words_[at] = static_cast<uint32_t>(changed);
    return (changed >> 32) & 1u;
  }

  /// Rounds a quotient in units of the least float, and what is left of it.
  static uint32_t least(uint64_t value, uint64_t rest, uint32_t n) noexcept {
    const bool up = 2 * rest > n || (2 * rest == n && value % 2 != 0);
    return static_cast<uint32_t>(value) + (up ? 1u : 0u);
  }

  /// Rounds value x 2^unit, and more if inexact, in units of the least float, to 24 of its bits.
  static uint32_t nearest(uint64_t value, uint32_t unit, bool inexact) noexcept {
    uint32_t high = 0;  // the highest bit
    for (uint32_t step = 32; step != 0; step /= 2)
      if (value >> (high + step) != 0) high += step;
    const uint32_t dropped = high - kFraction;
    const uint64_t kept = value >> dropped, lost = value - (kept << dropped);
    const uint64_t half = uint64_t{1} << (dropped - 1);
    const bool up = lost > half || (lost == half && (inexact || kept % 2 != 0));
    return ((unit + dropped) << kFraction) + static_cast<uint32_t>(kept) + (up ? 1u : 0u);
  }

  uint32_t words_[kWords];
};

}  // namespace detail

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
inline uint32_t mean_push(uint32_t* storage, MeanState& state, uint32_t n, uint32_t bits) noexcept {
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
  static_assert(Steps >= 2 && Steps <= 0x7fffffffu, "the sum holds at most 2^31 numbers");

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
