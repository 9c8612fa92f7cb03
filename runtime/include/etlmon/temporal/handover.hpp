// SPDX-License-Identifier: MIT
// Handovers in a window: one signal holds up to some position, another from there on. Takes:
// elements of two adjacent segments of positions, the older first. Gives: the element of their
// union, and of the empty segment. Keeps true: combine is associative and identity is neutral.
// Segments must not overlap.  The dual: an interval is covered if every position in it has g, then
// or later in the interval, or f, then or earlier. G F[0,a] (p && F[0,b] q) evaluates this at every
// step for the intervals that its open windows share with settled positions: g is a completed
// answer, f is p, which may still be completed.
#pragma once

#include "etlmon/temporal/monoid.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

/// A handover over a segment of positions.
template <class Value>
struct Flanks {
  Value value;
  Value before;  ///< guard towards newer positions: min of f (dual: max)
  Value behind;  ///< guard towards older positions, of g
};

/// f hands over to g: max over j of min(min of f over [oldest, j], min of g over [j, newest]).
template <class Value>
struct Handover {
  using Element = Flanks<Value>;
  static constexpr bool kMayOverlap = false;
  static constexpr bool kNewestLast = true;
  static constexpr Element identity() noexcept {
    return {Lattice<Value>::bottom(), Lattice<Value>::top(), Lattice<Value>::top()};
  }
  static constexpr Element at(Value f, Value g) noexcept { return {min_of(f, g), f, g}; }
  static constexpr Element combine(Element older, Element newer) noexcept {
    return {max_of(min_of(older.value, newer.behind), min_of(older.before, newer.value)),
            min_of(older.before, newer.before), min_of(older.behind, newer.behind)};
  }
};

/// The dual of Handover: min over j of max(max of f over [oldest, j], max of g over [j, newest]).
template <class Value>
struct Covered {
  using Element = Flanks<Value>;
  static constexpr bool kMayOverlap = false;
  static constexpr bool kNewestLast = true;
  static constexpr Element identity() noexcept {
    return {Lattice<Value>::top(), Lattice<Value>::bottom(), Lattice<Value>::bottom()};
  }
  static constexpr Element at(Value f, Value g) noexcept { return {max_of(f, g), f, g}; }
  static constexpr Element combine(Element older, Element newer) noexcept {
    return {min_of(max_of(older.value, newer.behind), max_of(older.before, newer.value)),
            max_of(older.before, newer.before), max_of(older.behind, newer.behind)};
  }
};

template <class Value>
constexpr Flanks<typename Lattice<Value>::End> low_of(Flanks<Value> e) noexcept {
  return {e.value.low, e.before.low, e.behind.low};
}
template <class Value>
constexpr Flanks<typename Lattice<Value>::End> high_of(Flanks<Value> e) noexcept {
  return {e.value.high, e.before.high, e.behind.high};
}
template <class End>
constexpr auto pair_of(Flanks<End> low, Flanks<End> high) noexcept
    -> Flanks<decltype(pair_of(low.value, high.value))> {
  return {pair_of(low.value, high.value), pair_of(low.before, high.before),
          pair_of(low.behind, high.behind)};
}
template <class Value>
constexpr bool same_ends(Flanks<Value> e) noexcept {
  return same_ends(e.before) && same_ends(e.behind) && same_ends(e.value);
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
