// SPDX-License-Identifier: MIT
// How often something held within a window, compared with a number. Takes: a value per step. Gives:
// whether it held at n or more of the last N steps, as the n-th greatest of their values; AllBut:
// whether it failed at fewer than n of them, as the n-th least. Keeps true: steps before the first
// do not count. A window of values keeps them in the order of time and of value; a step moves those
// between the value that leaves and the one that enters, none if they are equal. A long one with a
// small n keeps the n greatest of its segments, which are a monoid, so that the work of a step does
// not depend on N. A window of truth values keeps two bits a step, and two counters.
#pragma once

#include "etlmon/temporal/boolean_window.hpp"
#include "etlmon/temporal/delay.hpp"
#include "etlmon/temporal/window.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

/// The n greatest values of a segment, the greatest first.
template <class Value, uint32_t n>
struct GreatestFew {
  Value values[n];
};

/// Returns whether a is greater.
constexpr bool exceeds(Key a, Key b) noexcept { return b < a; }

template <uint32_t n>
struct Nth {
  static_assert(n >= 1, "something is counted");

  /// The monoid of the n greatest of a segment of ends.
  template <class Value>
  struct Of {
    using Element = GreatestFew<Value, n>;
    static constexpr bool kMayOverlap = false;
    static constexpr bool kNewestLast = true;
    static constexpr Element identity() noexcept { return at(Lattice<Value>::bottom()); }
    static constexpr Element at(Value value) noexcept {
      Element element{};
      element.values[0] = value;
      for (uint32_t i = 1; i < n; ++i) element.values[i] = Lattice<Value>::bottom();
      return element;
    }
    /// Merges two lists, and keeps the first n.
    static constexpr Element combine(const Element& older, const Element& newer) noexcept {
      Element result{};
      for (uint32_t i = 0, k = 0; i + k < n;) {
        const bool takes_newer = exceeds(newer.values[k], older.values[i]);
        const uint32_t at = i + k;
        result.values[at] = takes_newer ? newer.values[k++] : older.values[i++];
      }
      return result;
    }
  };
};

template <class Value, uint32_t n>
constexpr GreatestFew<typename Lattice<Value>::End, n> low_of(
    const GreatestFew<Value, n>& e) noexcept {
  GreatestFew<typename Lattice<Value>::End, n> result{};
  for (uint32_t i = 0; i < n; ++i) result.values[i] = e.values[i].low;
  return result;
}
template <class Value, uint32_t n>
constexpr GreatestFew<typename Lattice<Value>::End, n> high_of(
    const GreatestFew<Value, n>& e) noexcept {
  GreatestFew<typename Lattice<Value>::End, n> result{};
  for (uint32_t i = 0; i < n; ++i) result.values[i] = e.values[i].high;
  return result;
}
template <class End, uint32_t n>
constexpr auto pair_of(const GreatestFew<End, n>& low, const GreatestFew<End, n>& high) noexcept
    -> GreatestFew<decltype(pair_of(low.values[0], high.values[0])), n> {
  GreatestFew<decltype(pair_of(low.values[0], high.values[0])), n> result{};
  for (uint32_t i = 0; i < n; ++i) result.values[i] = pair_of(low.values[i], high.values[i]);
  return result;
}
template <class Value, uint32_t n>
constexpr bool same_ends(const GreatestFew<Value, n>& e) noexcept {
  for (uint32_t i = 0; i < n; ++i)
    if (!same_ends(e.values[i])) return false;
  return true;
}

/// Whether a window keeps all its values in order. In long ones a step would move too many.
constexpr bool keeps_order(uint32_t n, uint32_t length) noexcept {
  constexpr uint32_t kLargestFew = 100, kMovesForEach = 64;
  return n > kLargestFew || length <= kMovesForEach * n;
}

/// The ends of the last Length values, the least first.
template <class End, uint32_t Length>
class Ordered {
 public:
  constexpr void reset(End end) noexcept {
    for (End& each : ends_) each = end;
  }

  /// Returns the n-th greatest.
  End nth(uint32_t n) const noexcept {
    return n > Length ? Lattice<End>::bottom() : ends_[Length - n];
  }

  /// Replaces an end that equals `leaves`. Only those strictly between the two move.
  void exchange(End leaves, End enters) noexcept {
    if (exceeds(enters, leaves)) {
      const uint32_t to = below(enters) - 1;
      for (uint32_t i = below(leaves, true) - 1; i < to; ++i) ends_[i] = ends_[i + 1];
      ends_[to] = enters;
    } else if (exceeds(leaves, enters)) {
      const uint32_t to = below(enters, true);
      for (uint32_t i = below(leaves); i > to; --i) ends_[i] = ends_[i - 1];
      ends_[to] = enters;
    }
  }

 private:
  /// Returns how many are less than `end`, or equal to it.
  uint32_t below(End end, bool or_equal = false) const noexcept {
    uint32_t first = 0;
    for (uint32_t rest = Length, half = 0; rest > 0; rest -= half) {
      half = rest - rest / 2;
      const End middle = ends_[first + half - 1];
      const bool is_below = exceeds(end, middle) || (or_equal && !exceeds(middle, end));
      first += half & (0u - static_cast<uint32_t>(is_below));  // a branch would be unpredictable
    }
    return first;
  }

  End ends_[Length];
};

/// The n-th greatest of the last Length values, in order. While no sample among them is missing,
/// the highs are the lows.
template <class Value, uint32_t n, uint32_t Length, bool in_order>
class NthOfLast {
 public:
  constexpr void reset() noexcept {
    last_.reset(Lattice<Value>::bottom());
    lows_.reset(Lattice<End>::bottom());
    apart_ = 0;
  }

  ETLMON_STEP Value push(Value now) noexcept {
    const Value leaves = last_.push(now);
    if (apart_ != 0 || !same_ends(now)) return push_apart(leaves, now);
    lows_.exchange(low_of(leaves), low_of(now));
    return pair_of(lows_.nth(n), lows_.nth(n));
  }

 private:
  using End = typename Lattice<Value>::End;

  ETLMON_COLD Value push_apart(Value leaves, Value now) noexcept {
    if (apart_ == 0) highs_ = lows_;
    apart_ = apart_ + (same_ends(now) ? 0u : 1u) - (same_ends(leaves) ? 0u : 1u);
    lows_.exchange(low_of(leaves), low_of(now));
    highs_.exchange(high_of(leaves), high_of(now));
    return pair_of(lows_.nth(n), highs_.nth(n));
  }

  Delay<Value, Length> last_;
  Ordered<End, Length> lows_;
  Ordered<End, Length> highs_;  ///< written before read
  uint32_t apart_;              ///< of the last, those whose ends differ
};

/// The same, of the n greatest of each segment.
template <class Value, uint32_t n, uint32_t Length>
class NthOfLast<Value, n, Length, false> {
  using Few = typename Nth<n>::template Of<Value>;

 public:
  constexpr void reset() noexcept { window_.reset(); }

  Value push(Value value) noexcept { return window_.push(Few::at(value)).values[n - 1]; }

 private:
  Window<Few, Length> window_;
};

/// It held at n or more of the last Length steps.
template <class Value, uint32_t n, uint32_t Length>
class AtLeast : public NthOfLast<Value, n, Length, keeps_order(n, Length)> {};

/// The same of truth values, by two counters.
template <uint32_t n, uint32_t Length>
class AtLeast<Truth, n, Length> {
 public:
  constexpr void reset() noexcept {
    last_.reset(kNo);
    low_ = high_ = 0;
  }

  Truth push(Truth now) noexcept {
    const Truth leaves = last_.push(now);
    low_ = low_ + (now.low ? 1u : 0u) - (leaves.low ? 1u : 0u);
    high_ = high_ + (now.high ? 1u : 0u) - (leaves.high ? 1u : 0u);
    return {low_ >= n, high_ >= n};
  }

 private:
  Delay<Truth, Length> last_;
  uint32_t low_;   ///< of the last, those that are surely true
  uint32_t high_;  ///< and possibly true
};

/// The dual of AtLeast: it failed at fewer than n of the last Length steps.
template <class Value, uint32_t n, uint32_t Length>
class AllBut {
 public:
  constexpr void reset() noexcept { failed_.reset(); }
  Value push(Value value) noexcept { return negate(failed_.push(negate(value))); }

 private:
  AtLeast<Value, n, Length> failed_;
};

}  // namespace ETLMON_BUILD
}  // namespace etlmon
