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

/// A sum of at most kMostNumbers finite floats, without rounding, in units of 2^-149, the least
/// float: parts of 64 bits, 32 places apart. No part overflows, so carries can wait until the sum
/// is asked for.
class ExactSum {
 public:
  constexpr void reset() noexcept {
    for (uint32_t& half : halves_) half = 0;
  }

  /// Adds a finite float, or takes one away that was added before.
  void add(uint32_t bits, bool take_away) noexcept {
    const uint32_t exponent = (bits >> kFraction) & 0xffu, fraction = bits & (kOne - 1);
    const uint32_t shift = exponent == 0 ? 0 : exponent - 1;
    const uint32_t digits = exponent == 0 ? fraction : fraction | kOne;
    const bool negative = ((bits & kSignBit) != 0) != take_away;
    change(shift / 32, digits << (shift % 32), negative);
    change(shift / 32 + 1, (digits >> 1) >> (31 - shift % 32), negative);
  }

  /// Returns the bits of the sum divided by n, rounded to the nearest float, ties to even.
  ETLMON_STEP uint32_t divided_by(uint32_t n) const noexcept {
#if defined(__GNUC__) && UINTPTR_MAX > 0xffffffffu
    // Nearly always three parts are all there is, and these processors divide 64 bits: the first
    // 64 of the sum decide, with whether others follow.
    uint32_t top = kParts - 1;
    while (top > 2 && part(top) == 0) --top;
    uint64_t below = 0;
    for (uint32_t i = 0; i + 2 < top; ++i) below |= part(i);
    const uint64_t second = part(top - 1) + over(part(top - 2));
    const uint64_t first = part(top) + over(second);
    const bool negative = (first >> 63) != 0;
    uint64_t low = (second << 32) | (part(top - 2) & 0xffffffffu);
    uint64_t high = negative ? ~first + (low == 0 ? 1 : 0) : first;
    low = negative ? 0 - low : low;
    if (below == 0 && (high | low) == 0) return 0;
    if (below == 0) {
      const int32_t zeros = high != 0 ? __builtin_clzll(high) : 64 + __builtin_clzll(low);
      if (zeros >= 64) high = low;
      if (zeros >= 64) low = 0;
      const uint32_t by = static_cast<uint32_t>(zeros) % 64;
      high = (high << by) | (low >> 1 >> (63 - by));
      const uint64_t quotient = high / n;  // at least 40 bits
      const bool inexact = high - quotient * n != 0 || low << by != 0;
      const int32_t more = __builtin_clzll(quotient);
      const int32_t unit = static_cast<int32_t>(top - 2) * 32 + 64 + 40 - zeros - more;
      const uint64_t digits = quotient << more, kept = digits >> 40;
      const uint64_t lost = (digits << 24) + (inexact ? 2 : 0) + kept % 2;
      if (unit >= 0) {  // 24 digits fit in a float
        const uint32_t result = (static_cast<uint32_t>(unit) << kFraction) +
                                static_cast<uint32_t>(kept) + (lost > uint64_t{1} << 63 ? 1 : 0);
        return negative ? result | kSignBit : result;
      }
    }
#endif
    return divided_slowly(n);
  }

 private:
  static constexpr uint32_t kFraction = 23;          // bits
  static constexpr uint32_t kOne = 1u << kFraction;  // the bit that normal floats do not store
  static constexpr uint32_t kParts = 9;              // 277 bits of a float
  static constexpr uint32_t kWords = 10;             // and 24 of their number, and a sign

  uint64_t part(uint32_t at) const noexcept {
    return halves_[2 * at] | (static_cast<uint64_t>(halves_[2 * at + 1]) << 32);
  }
  void change(uint32_t at, uint32_t by, bool negative) noexcept {
    const uint64_t sign = negative ? ~uint64_t{0} : 0;  // signs are unpredictable: no branch
    const uint64_t changed = part(at) + ((by ^ sign) - sign);
    halves_[2 * at] = static_cast<uint32_t>(changed);
    halves_[2 * at + 1] = static_cast<uint32_t>(changed >> 32);
  }
  /// Returns what the next part takes over: the upper half, with its sign.
  static uint64_t over(uint64_t part) noexcept {
    return (part >> 32) | ((part >> 63) == 0 ? 0 : ~uint64_t{0} << 32);
  }

  /// The same for any sum. Divides bytes, and shifts words, since small processors divide and shift
  /// 32 bits only.
  uint32_t divided_slowly(uint32_t n) const noexcept {
    uint32_t size[kWords];
    uint64_t carry = 0;
    for (uint32_t i = 0; i < kWords; ++i) {
      carry += i < kParts ? part(i) : 0;
      size[i] = static_cast<uint32_t>(carry);
      carry = over(carry);
    }
    const bool negative = (size[kWords - 1] & kSignBit) != 0;
    bool carries = negative;
    for (uint32_t i = 0; negative && i < kWords; ++i) {
      size[i] = ~size[i] + (carries ? 1 : 0);
      carries = carries && size[i] == 0;
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

  uint32_t halves_[2 * kParts];
};

}  // namespace detail
}  // namespace ETLMON_BUILD
}  // namespace etlmon
