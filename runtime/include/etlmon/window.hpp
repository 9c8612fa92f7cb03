// SPDX-License-Identifier: MIT
// Sliding aggregates: the combination of the last N elements of a stream, for any monoid, in constant time a step.
// Takes: one element a step. Gives: combine(oldest, ..., newest) over the last N; identity stands before the first.
// Keeps true: at most window_operations(N) combinations in any step, whatever the history; state N + 2 elements.
//
// The method cuts the stream into blocks of N / 2 (rounded down), so that the window is always
//     a suffix of the oldest block  |  the middle block, whole  |  a prefix of the newest block
// and, where N is odd, the newest block may be whole too. The suffix is read from a table, the other two are running
// totals. The table for the middle block, which is the next oldest, is built in place from its end while the newest
// block fills, one entry a step: it is complete when it is due. The oldest block is given up from its front at the pace
// at which the newest grows, so these two share their slots, and the next entry to build mirrors the next slot to fill.
// (Suffix and prefix tables: van Herk 1992, Gil and Werman 1993; half-blocks keep a step from building a whole table.)
#pragma once

#include <stdint.h>

#include "etlmon/delay.hpp"
#include "etlmon/monoid.hpp"

// Where speed counts, the length is folded into each window's step; where size counts, all lengths share one.
#if defined(__OPTIMIZE_SIZE__)
#define ETLMON_WINDOW_STEP
#else
#define ETLMON_WINDOW_STEP ETLMON_INLINE
#endif

namespace etlmon {

/// Elements of storage that a window over the last n >= 1 needs: two totals, two blocks.
constexpr uint32_t window_elements(uint32_t n) noexcept { return (n & ~uint32_t{1}) + 2; }

/// The most combinations that any step of a window over the last n >= 1 performs. Long runs reach it.
constexpr uint32_t window_operations(uint32_t n) noexcept { return n == 1 ? 0 : n < 4 ? n : 4; }

/// Empties a window: storage of window_elements(n).
template <class Monoid>
void window_reset(typename Monoid::Element* storage, uint32_t& cursor, uint32_t n) noexcept {
  cursor = 0;
  for (uint32_t i = 0; i < window_elements(n); ++i) storage[i] = Monoid::identity();
}

/// oldest, middle and newest of a window together, in the order that is cheaper.
template <class Monoid>
constexpr typename Monoid::Element window_total(typename Monoid::Element oldest, typename Monoid::Element middle,
                                                typename Monoid::Element newest) noexcept {
  return Monoid::kNewestLast ? Monoid::combine(Monoid::combine(oldest, middle), newest)
                             : Monoid::combine(oldest, Monoid::combine(middle, newest));
}

/// One step of a window over the last n >= 1 elements: the combination of those, this one included.
/// storage: window_elements(n) elements that window_reset prepared; cursor: the slot of the ring that this step fills.
template <class Monoid>
ETLMON_WINDOW_STEP typename Monoid::Element window_push(typename Monoid::Element* storage, uint32_t& cursor, uint32_t n,
                                                        typename Monoid::Element element) noexcept {
  using Element = typename Monoid::Element;
  if (n == 1) return element;
  const bool odd = n % 2 != 0;
  const uint32_t slots = n & ~uint32_t{1};
  Element& middle = storage[0];
  Element& newest = storage[1];
  Element* ring = storage + 2;

  const Element total = Monoid::combine(newest, element);
  Element aggregate = total;
  if (odd) aggregate = window_total<Monoid>(ring[cursor], middle, total);  // the slot's suffix, before it is filled
  ring[cursor] = element;
  uint32_t next = cursor + 1;
  if (n < 4 || next == slots / 2 || next == slots) {  // the newest block is full: every block is one older from here
    if (next == slots) next = 0;
    middle = total;
    newest = Monoid::identity();
    if (!odd) aggregate = Monoid::combine(ring[next], total);
  } else {
    newest = total;
    ring[slots - 1 - next] = Monoid::combine(ring[slots - 1 - next], ring[slots - next]);
    if (!odd) aggregate = window_total<Monoid>(ring[next], middle, total);
  }
  cursor = next;
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

/// Over pairs of keys: the lows and the highs never meet, and as two windows they stay in scalar registers, where one
/// window over pairs makes compilers pack and unpack them (1.5 to 2 times slower on x86-64).
template <template <class> class Operator, uint32_t N>
class Window<Operator<Value>, N> {
 public:
  using Element = typename Operator<Value>::Element;

  void reset() noexcept {
    low_.reset();
    high_.reset();
  }

  Element push(Element element) noexcept { return pair_of(low_.push(low_of(element)), high_.push(high_of(element))); }

 private:
  Window<Operator<Key>, N> low_;
  Window<Operator<Key>, N> high_;
};

/// From the aggregate of the last M to that of the last N of one stream, M < N <= 2 M: one combination and a delay by
/// N - M instead of a second window, where several windows watch one signal. Only for operators whose segments may
/// overlap.
template <class Monoid, uint32_t M, uint32_t N>
class Widening {
  static_assert(M < N && N - M <= M, "the two shorter windows must meet");
  static_assert(Monoid::kMayOverlap, "an element that both windows hold would count twice");

 public:
  using Element = typename Monoid::Element;

  /// Forgets all elements; time proportional to N - M.
  void reset() noexcept { past_.reset(Monoid::identity()); }

  /// Takes this step's aggregate of the last M, gives that of the last N.
  Element push(Element aggregate) noexcept { return Monoid::combine(past_.push(aggregate), aggregate); }

 private:
  Delay<Element, N - M> past_;
};

template <class Monoid>
struct WindowBytes {
  static constexpr uint32_t of(uint32_t n) noexcept {
    return storage_bytes(window_elements(n) * static_cast<uint32_t>(sizeof(typename Monoid::Element)));
  }
};

template <template <class> class Operator>
struct WindowBytes<Operator<Value>> {
  static constexpr uint32_t of(uint32_t n) noexcept { return 2 * WindowBytes<Operator<Key>>::of(n); }
};

/// sizeof(Window<Monoid, n>).
template <class Monoid>
constexpr uint32_t window_bytes(uint32_t n) noexcept {
  return WindowBytes<Monoid>::of(n);
}

}  // namespace etlmon
