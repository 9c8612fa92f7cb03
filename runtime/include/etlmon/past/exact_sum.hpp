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
    const uint32_t digits = exponent == 0 ? fraction : fraction | kOne;
    const bool negative = ((bits & kSignBit) != 0) != take_away;
    uint32_t at = shift / 32;
    uint64_t rest = change(at, digits << (shift % 32), 0, negative);
    rest = change(++at, (digits >> 1) >> (31 - shift % 32), rest, negative);
    while (rest != 0 && ++at < kWords) rest = change(at, 0, rest, negative);
  }

  /// Returns the bits of the sum divided by n, rounded to the nearest float, ties to even. Divides
  /// bytes, and shifts words, since small processors divide and shift 32 bits only.
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
    const uint32_t high = quotient[wide ? 0 : 1], low = quotient[wide ? 1 : 2];
    inexact = (wide && quotient[2] != 0) || rest != 0 || inexact;
    const uint32_t unit = (top - 2) * 32 + (wide ? 32 : 0);
    const uint32_t bits = unit == 0 && high == 0 && low < 2 * kOne
                              ? least(low, rest, n)
                              : nearest(high, low, unit, inexact);
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
  static uint32_t least(uint32_t value, uint32_t rest, uint32_t n) noexcept {
    const bool up = 2 * rest > n || (2 * rest == n && value % 2 != 0);
    return value + (up ? 1u : 0u);
  }

  /// Rounds a number of two words x 2^unit, and more if inexact, in units of the least float, to
  /// its first 24 bits. It has more.
  static uint32_t nearest(uint32_t high, uint32_t low, uint32_t unit, bool inexact) noexcept {
    uint32_t dropped = 64 - 1 - kFraction;
    if (high == 0) {
      high = low;
      low = 0;
      dropped -= 32;
    }
    for (uint32_t step = 16; step != 0; step /= 2) {  // until the highest bit is the first
      if (high >> (32 - step) != 0) continue;
      high = (high << step) | (low >> (32 - step));
      low <<= step;
      dropped -= step;
    }
    const uint32_t kept = high >> 8, lost = high & 0xffu;
    const bool more = low != 0 || inexact;
    const bool up = lost > 0x80u || (lost == 0x80u && (more || kept % 2 != 0));
    return ((unit + dropped) << kFraction) + kept + (up ? 1u : 0u);
  }

  uint32_t words_[kWords];
};

}  // namespace detail
}  // namespace ETLMON_BUILD
}  // namespace etlmon
