// What a window aggregates: the temporal operators as associative combinations of neighbouring segments of a stream.
// Takes: elements of two adjacent segments, the older first. Gives: the element of their union, and that of no segment.
// Keeps true: combine is associative, identity is neutral on both sides, and the segments may overlap as long as
// neither contains the other's outer end: combine(of [a, c], of [b, d]) is the element of [a, d] for a <= b <= c + 1, c
// <= d. SPDX-License-Identifier: MIT
#pragma once

#include "etlmon/value.hpp"

namespace etlmon {

/// Greatest value of the segment: O over the last N, F over the next N.
template <class V>
struct Greatest {
  using Element = V;
  static constexpr Element identity() noexcept { return Lattice<V>::bottom(); }
  static constexpr Element combine(Element older, Element newer) noexcept { return max(older, newer); }
};

/// Least value of the segment: H over the last N, G over the next N.
template <class V>
struct Least {
  using Element = V;
  static constexpr Element identity() noexcept { return Lattice<V>::top(); }
  static constexpr Element combine(Element older, Element newer) noexcept { return min(older, newer); }
};

/// A binary operator over a segment of positions. One position: value is the right operand g, guard the left operand f.
template <class V>
struct Span {
  V value;  ///< the operator's value at the end of the segment that the operator looks from
  V guard;  ///< what the segment lets through from beyond its other end: min of f (since, until), max of f (duals)
};

/// f S g seen from the newest position: max over j of min(g(j), min of f over (j, newest]).
template <class V>
struct Since {
  using Element = Span<V>;
  static constexpr Element identity() noexcept { return {Lattice<V>::bottom(), Lattice<V>::top()}; }
  static constexpr Element combine(Element older, Element newer) noexcept {
    return {max(min(older.value, newer.guard), newer.value), min(older.guard, newer.guard)};
  }
};

/// The dual of Since: min over j of max(g(j), max of f over (j, newest]).
template <class V>
struct Trigger {
  using Element = Span<V>;
  static constexpr Element identity() noexcept { return {Lattice<V>::top(), Lattice<V>::bottom()}; }
  static constexpr Element combine(Element older, Element newer) noexcept {
    return {min(max(older.value, newer.guard), newer.value), max(older.guard, newer.guard)};
  }
};

/// f U g seen from the oldest position: max over j of min(g(j), min of f over [oldest, j)).
template <class V>
struct Until {
  using Element = Span<V>;
  static constexpr Element identity() noexcept { return {Lattice<V>::bottom(), Lattice<V>::top()}; }
  static constexpr Element combine(Element older, Element newer) noexcept {
    return {max(older.value, min(older.guard, newer.value)), min(older.guard, newer.guard)};
  }
};

/// f R g, the dual of Until: min over j of max(g(j), max of f over [oldest, j)).
template <class V>
struct Release {
  using Element = Span<V>;
  static constexpr Element identity() noexcept { return {Lattice<V>::top(), Lattice<V>::bottom()}; }
  static constexpr Element combine(Element older, Element newer) noexcept {
    return {min(older.value, max(older.guard, newer.value)), max(older.guard, newer.guard)};
  }
};

}  // namespace etlmon
