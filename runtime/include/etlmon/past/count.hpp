// SPDX-License-Identifier: MIT
// How often something held within a window, compared with a number. Takes: a value per step. Gives:
// whether it held at n or more of the last N steps, as the n-th greatest of their values; AllBut:
// whether it failed at fewer than n of them, as the n-th least. Keeps true: steps before the first
// do not count; the work of a step depends on n and not on N. The n greatest of a segment are a
// monoid, so a window of values keeps n elements per position; one of truth values keeps two bits.
#pragma once

#include "etlmon/temporal/boolean_window.hpp"
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

/// It held at n or more of the last Length steps.
template <class Value, uint32_t n, uint32_t Length>
class AtLeast {
  using Few = typename Nth<n>::template Of<Value>;

 public:
  constexpr void reset() noexcept { window_.reset(); }

  Value push(Value value) noexcept { return window_.push(Few::at(value)).values[n - 1]; }

 private:
  Window<Few, Length> window_;
};

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
