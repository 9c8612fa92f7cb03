// Sliding aggregates: the combination of the last N elements of a stream, for any monoid, in constant time a step.
// Takes: one element a step. Gives: combine(oldest, ..., newest) over the last N, elements before the first being
// identity. Keeps true: at most window_operations(N) combinations in any step, whatever the history; N + 2 elements of
// state.
//
// The method cuts the stream into blocks of N / 2, so that the window is always
//     a suffix of the oldest block  |  the middle block, whole  |  a prefix of the newest block.
// The suffix is read from a table, the other two are running totals, and the table for the middle block, which is the
// next oldest, is built in place from its end while the newest block fills, one entry a step: complete when it is due.
// As the oldest block is given up from its front at the pace at which the newest grows, these two share their slots.
// (van Herk's and Gil and Werman's suffix and prefix tables, with half-blocks so that no step ever builds a whole
// table.)
//
// The pending half of G(p -> F[0,w] q) on a prefix, min over the last w positions k of max(!p(k), max of q over [k,
// now]), is Window<Trigger<V>, w> over elements {max(!p, q), q}: the guard is q, which settles every older position at
// once. SPDX-License-Identifier: MIT
#pragma once

#include <stdint.h>

#include "etlmon/monoid.hpp"

namespace etlmon {

/// Elements of storage that a window over the last n >= 1 needs: two totals and the blocks.
constexpr uint32_t window_elements(uint32_t n) noexcept { return (n & ~uint32_t{1}) + 2; }

/// The most combinations that any step of a window over the last n >= 1 performs.
constexpr uint32_t window_operations(uint32_t n) noexcept { return n < 5 ? n - 1 : 4; }

/// Empties a window: storage of window_elements(n).
template <class Monoid>
void window_reset(typename Monoid::Element* storage, uint32_t& cursor, uint32_t n) noexcept {
  cursor = 0;
  for (uint32_t i = 0; i < window_elements(n); ++i) storage[i] = Monoid::identity();
}

/// One step of a window over the last n >= 1 elements: the combination of those, this one included.
/// storage: window_elements(n) elements that window_reset prepared; cursor: the slot of the ring where the step begins.
template <class Monoid>
typename Monoid::Element window_push(typename Monoid::Element* storage, uint32_t& cursor, uint32_t n,
                                     typename Monoid::Element element) noexcept {
  using Element = typename Monoid::Element;
  if (n == 1) return element;
  const uint32_t slots = n & ~uint32_t{1};
  const uint32_t block = n / 2;
  Element& middle = storage[0];
  Element& newest = storage[1];
  Element* ring = storage + 2;
  uint32_t at = cursor;

  if (n % 2 == 0) {
    const Element total = at == 0 || at == block ? element : Monoid::combine(newest, element);
    ring[at] = element;
    at = at + 1 == slots ? 0 : at + 1;
    cursor = at;
    if (at == 0 || at == block) {
      middle = total;
      return Monoid::combine(ring[at], total);
    }
    newest = total;
    ring[slots - 1 - at] = Monoid::combine(ring[slots - 1 - at], ring[slots - at]);
    return Monoid::combine(ring[at], Monoid::combine(middle, total));
  }
  Element total = element;
  Element inner = newest;
  if (at == 0 || at == block) {
    middle = inner;
  } else {
    ring[slots - 1 - at] = Monoid::combine(ring[slots - 1 - at], ring[slots - at]);
    total = Monoid::combine(inner, element);
    inner = middle;
  }
  newest = total;
  const Element aggregate = Monoid::combine(ring[at], Monoid::combine(inner, total));
  ring[at] = element;
  cursor = at + 1 == slots ? 0 : at + 1;
  return aggregate;
}

/// The aggregate of the last N elements. Monoid::Element: trivially copyable, alignment at most 4.
template <class Monoid, uint32_t N>
class Window {
  static_assert(N >= 1 && N <= 0x7fffffffu, "a window holds at least this step");
  static_assert(alignof(typename Monoid::Element) <= alignof(uint32_t), "the cursor comes first, without padding");

 public:
  using Element = typename Monoid::Element;

  /// Forgets all elements; time proportional to N.
  void reset() noexcept { window_reset<Monoid>(storage_, cursor_, N); }

  /// Takes this step's element, gives the combination of the last N, oldest first.
  Element push(Element element) noexcept { return window_push<Monoid>(storage_, cursor_, N, element); }

 private:
  uint32_t cursor_;
  Element storage_[window_elements(N)];
};

/// sizeof(Window<Monoid, n>).
template <class Monoid>
constexpr uint32_t window_bytes(uint32_t n) noexcept {
  constexpr uint32_t cursor = sizeof(uint32_t);
  const uint32_t storage = window_elements(n) * static_cast<uint32_t>(sizeof(typename Monoid::Element));
  return (cursor + storage + cursor - 1) / cursor * cursor;
}

}  // namespace etlmon
