// SPDX-License-Identifier: MIT
// Sums of floats without rounding, in integers. Takes: the bits of finite floats, to add or to take
// away. Gives: the sum divided by a number, rounded once. Keeps true: constant work, the same bits
// in every build, no double.
#pragma once

#include <stdint.h>

#include "etlmon/bits.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {
namespace detail {

/// The most floats in a sum, and the greatest divisor.
constexpr uint32_t kMostNumbers = 1u << 24;

/// A sum of at most kMostNumbers finite floats, without rounding: a two's complement number in
/// units of 2^-149, the least float.
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

  /// Returns the bits of the sum divided by n, rounded to the nearest float, ties to even. Divides
  /// bytes, since small processors divide 32 bits only.
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
    uint32_t rest = 0;          // less than n, so that the next byte fits behind it
    uint32_t quotient[3] = {};  // from the top: at least 40 bits unless these are all words
    for (uint32_t i = 0; i < 12; ++i) {
      const uint32_t part = (rest << 8) | ((size[top - i / 4] >> (24 - i % 4 * 8)) & 0xffu);
      quotient[i / 4] = (quotient[i / 4] << 8) | (part / n);
      rest = part % n;
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
  static constexpr uint32_t kWords = 10;  // 277 bits of a float, 24 of their number, and a sign

  /// Adds to a word, or subtracts from it. Returns what the next word has to take over.
  uint64_t change(uint32_t at, uint32_t part, uint64_t rest, bool negative) noexcept {
    const uint64_t word = words_[at];
    const uint64_t changed = negative ? word - part - rest : word + part + rest;
    words_[at] = static_cast<uint32_t>(changed);
    return (changed >> 32) & 1u;
  }

  /// Rounds a quotient in units of the least float, and what is left of it.
  static uint32_t least(uint64_t value, uint32_t rest, uint32_t n) noexcept {
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
}  // namespace ETLMON_BUILD
}  // namespace etlmon
