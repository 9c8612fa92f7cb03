// SPDX-License-Identifier: MIT
// The aggregates of windows: temporal operators as associative combinations of adjacent segments of
// a stream. Takes: elements of two segments, the older first. Gives: the element of their union,
// and of the empty segment. Keeps true: combine is associative and identity is neutral. Segments
// may overlap (kMayOverlap): for a <= b <= c + 1 and c <= d, combine(element of [a, c], element of
// [b, d]) is the element of [a, d]. kNewestLast: (older, middle), newest costs less than older,
// (middle, newest); the results are equal.  The pending half of G(p -> F[0,w] q) on a prefix, the
// min over the last w positions k of max(!p(k), q over [k, now]), is Trigger over w elements
// {max(!p, q), q}, whose guard q settles all older positions at once. No window is needed if
// earlier positions are settled each by its own window: the unbounded z = max(min(z, !p), q) then
// differs only in the terms of settled positions, which are not below their settled values.
#pragma once

#include "etlmon/temporal/value.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

/// The aggregate of the last Length elements: window.hpp, and boolean_window.hpp for truth values.
template <class Monoid, uint32_t Length>
class Window;

/// Greatest value of a segment: O and F.
template <class Value>
struct Greatest {
  using Element = Value;
  static constexpr bool kMayOverlap = true;
  static constexpr bool kNewestLast = true;
  static constexpr Element identity() noexcept { return Lattice<Value>::bottom(); }
  static constexpr Element combine(Element older, Element newer) noexcept {
    return max_of(older, newer);
  }
};

/// Least value of a segment: H and G.
template <class Value>
struct Least {
  using Element = Value;
  static constexpr bool kMayOverlap = true;
  static constexpr bool kNewestLast = true;
  static constexpr Element identity() noexcept { return Lattice<Value>::top(); }
  static constexpr Element combine(Element older, Element newer) noexcept {
    return min_of(older, newer);
  }
};

/// A binary operator over a segment of positions. At one position, value is the right operand g and
/// guard the left operand f.
template <class Value>
struct Span {
  Value value;  ///< the operator at the end of the segment that it is evaluated at
  Value guard;  ///< guard for values beyond the other end: min of f (since, until), max of f
                ///< (duals)
};

/// f S g at the newest position: max over j of min(g(j), min of f over (j, newest]).
template <class Value>
struct Since {
  using Element = Span<Value>;
  static constexpr bool kMayOverlap = true;
  static constexpr bool kNewestLast = true;
  static constexpr Element identity() noexcept {
    return {Lattice<Value>::bottom(), Lattice<Value>::top()};
  }
  static constexpr Element combine(Element older, Element newer) noexcept {
    return {max_of(min_of(older.value, newer.guard), newer.value),
            min_of(older.guard, newer.guard)};
  }
};

/// The dual of Since: min over j of max(g(j), max of f over (j, newest]).
template <class Value>
struct Trigger {
  using Element = Span<Value>;
  static constexpr bool kMayOverlap = true;
  static constexpr bool kNewestLast = true;
  static constexpr Element identity() noexcept {
    return {Lattice<Value>::top(), Lattice<Value>::bottom()};
  }
  static constexpr Element combine(Element older, Element newer) noexcept {
    return {min_of(max_of(older.value, newer.guard), newer.value),
            max_of(older.guard, newer.guard)};
  }
};

/// f U g at the oldest position: max over j of min(g(j), min of f over [oldest, j)).
template <class Value>
struct Until {
  using Element = Span<Value>;
  static constexpr bool kMayOverlap = true;
  static constexpr bool kNewestLast = false;
  static constexpr Element identity() noexcept {
    return {Lattice<Value>::bottom(), Lattice<Value>::top()};
  }
  static constexpr Element combine(Element older, Element newer) noexcept {
    return {max_of(older.value, min_of(older.guard, newer.value)),
            min_of(older.guard, newer.guard)};
  }
};

/// f R g, the dual of Until: min over j of max(g(j), max of f over [oldest, j)).
template <class Value>
struct Release {
  using Element = Span<Value>;
  static constexpr bool kMayOverlap = true;
  static constexpr bool kNewestLast = false;
  static constexpr Element identity() noexcept {
    return {Lattice<Value>::top(), Lattice<Value>::bottom()};
  }
  static constexpr Element combine(Element older, Element newer) noexcept {
    return {min_of(older.value, max_of(older.guard, newer.value)),
            max_of(older.guard, newer.guard)};
  }
};

/// The two ends of an element over pairs of keys. They never mix, since no combination negates.
constexpr Key low_of(Value v) noexcept { return v.low; }
constexpr Key high_of(Value v) noexcept { return v.high; }
constexpr Value pair_of(Key low, Key high) noexcept { return {low, high}; }
template <class Value>
constexpr Span<typename Lattice<Value>::End> low_of(Span<Value> s) noexcept {
  return {s.value.low, s.guard.low};
}
template <class Value>
constexpr Span<typename Lattice<Value>::End> high_of(Span<Value> s) noexcept {
  return {s.value.high, s.guard.high};
}
template <class End>
constexpr auto pair_of(Span<End> low, Span<End> high) noexcept
    -> Span<decltype(pair_of(low.value, high.value))> {
  return {pair_of(low.value, high.value), pair_of(low.guard, high.guard)};
}
constexpr bool same_ends(Value v) noexcept { return v.low == v.high; }
template <class Value>
constexpr bool same_ends(Span<Value> s) noexcept {
  return same_ends(s.value) && same_ends(s.guard);
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
