// SPDX-License-Identifier: MIT
// Sliding aggregates: the combination of the last N elements of a stream, for any monoid, in
// constant time a step. Takes: one element per step. Gives: combine(oldest, ..., newest) over the
// last N, with identity before the first. Keeps true: at most window_operations(N) combinations in
// any step; N + 2 elements of state.  The method cuts the stream into blocks of N / 2 (rounded
// down), so that the window is always a suffix of the oldest block  |  the middle block, whole  |
// a prefix of the newest block and, if N is odd, the newest block may be whole too. The suffix is
// read from a table; the other two are running totals. The table of the middle block, the next
// oldest, is built in place from its end while the newest block fills, one entry per step, so it is
// complete in time. The oldest block shrinks from its front as fast as the newest grows, so they
// share their slots, and the next entry to build mirrors the next slot to fill. (Suffix and prefix
// tables: van Herk 1992, Gil and Werman 1993; half-blocks avoid building a whole table in one
// step.)
#pragma once

#include <stdint.h>

#include "etlmon/temporal/monoid.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

/// Returns the elements of storage of a window over the last n >= 1: two totals, two blocks.
constexpr uint32_t window_elements(uint32_t n) noexcept { return (n & ~uint32_t{1}) + 2; }

/// Empties a window with window_elements(n) elements of storage.
template <class Monoid>
constexpr void window_reset(typename Monoid::Element* storage, uint32_t& cursor,
                            uint32_t n) noexcept {
  cursor = 0;
  for (uint32_t i = 0; i < window_elements(n); ++i) storage[i] = Monoid::identity();
}

/// Combines oldest, middle and newest, in the cheaper order.
template <class Monoid>
constexpr typename Monoid::Element window_total(typename Monoid::Element oldest,
                                                typename Monoid::Element middle,
                                                typename Monoid::Element newest) noexcept {
  return Monoid::kNewestLast ? Monoid::combine(Monoid::combine(oldest, middle), newest)
                             : Monoid::combine(oldest, Monoid::combine(middle, newest));
}

/// Takes a step of a window over the last n >= 1 elements, and returns their combination. storage:
/// window_elements(n) elements, prepared by window_reset; cursor: the slot of the ring for this
/// step.
template <class Monoid>
ETLMON_STEP typename Monoid::Element window_push(typename Monoid::Element* storage,
                                                 uint32_t& cursor, uint32_t n,
                                                 typename Monoid::Element element) noexcept {
  using Element = typename Monoid::Element;
  if (n == 1) return element;
  const bool odd = n % 2 != 0;
  const uint32_t places = n & ~uint32_t{1};
  Element& middle = storage[0];
  Element& newest = storage[1];
  Element* ring = storage + 2;

  const uint32_t at = cursor;
  const Element total = Monoid::combine(newest, element);
  Element aggregate = total;
  if (odd)
    aggregate = window_total<Monoid>(ring[at], middle, total);  // reads the slot's suffix before it
                                                                // is overwritten
  ring[at] = element;
  uint32_t next = at + 1;
  if (n < 4 || next == places / 2 ||
      next == places) {  // the newest block is full: every block becomes one older
    if (next == places) next = 0;
    middle = total;
    newest = Monoid::identity();
    if (!odd) aggregate = Monoid::combine(ring[next], total);
  } else {
    newest = total;
    ring[places - 1 - next] = Monoid::combine(ring[places - 1 - next], ring[places - next]);
    if (!odd) aggregate = window_total<Monoid>(ring[next], middle, total);
  }
  cursor = next;
  return aggregate;
}

/// The aggregate of the last Length elements. Monoid::Element: trivially copyable, alignment at
/// most 4.
template <class Monoid, uint32_t Length>
class Window {
  static_assert(Length >= 1 && Length <= 0x7fffffffu, "a window holds at least this step");
  static_assert(alignof(typename Monoid::Element) <= alignof(uint32_t),
                "the cursor comes first, without padding");

 public:
  using Element = typename Monoid::Element;

  /// Forgets all elements; takes time proportional to Length.
  constexpr void reset() noexcept { window_reset<Monoid>(storage_, cursor_, Length); }

  /// Takes this step's element, returns the combination of the last Length, oldest first.
  Element push(Element element) noexcept {
    return window_push<Monoid>(storage_, cursor_, Length, element);
  }

 private:
  uint32_t cursor_;
  Element storage_[window_elements(Length)];
};

/// Where the highs of a window over pairs differ from its lows: per block the first slot whose ends
/// differ, or kNowhere. From that slot on, the highs hold the elements of the block, of the oldest
/// block its whole suffix table; elsewhere the lows are also the highs.
struct Parting {
  static constexpr uint32_t kNowhere = 0xffffffffu;
  uint32_t newest, middle, oldest;

  constexpr void reset() noexcept { newest = middle = oldest = kNowhere; }
  bool nowhere() const noexcept { return (newest & middle & oldest) == kNowhere; }
  /// The newest block is full: every block becomes one older.
  void next_block() noexcept {
    oldest = middle == kNowhere ? kNowhere : 0;
    middle = newest;
    newest = kNowhere;
  }
};

/// Takes the step of the highs of a window over pairs of keys, once they differ from the lows; call
/// it before the step of the lows. The same steps as window_push, but reads the lows where both are
/// equal.
template <class Ends>
typename Ends::Element window_push_highs(const typename Ends::Element* lows,
                                         typename Ends::Element* highs, Parting& parting,
                                         uint32_t cursor, uint32_t n,
                                         typename Ends::Element element, bool parts) noexcept {
  using Element = typename Ends::Element;
  constexpr uint32_t kNowhere = Parting::kNowhere;
  const bool odd = n % 2 != 0;
  const uint32_t places = n & ~uint32_t{1};
  const auto suffix = [&](uint32_t etlmon_slot) noexcept {
    return (parting.oldest == kNowhere ? lows : highs)[2 + etlmon_slot];
  };
  const auto middle = [&]() noexcept { return (parting.middle == kNowhere ? lows : highs)[0]; };

  const Element total = Ends::combine((parting.newest == kNowhere ? lows : highs)[1], element);
  if (parts && parting.newest == kNowhere) parting.newest = cursor;
  Element aggregate = total;
  if (odd) aggregate = window_total<Ends>(suffix(cursor), middle(), total);
  highs[2 + cursor] = element;
  uint32_t next = cursor + 1;
  if (n < 4 || next == places / 2 || next == places) {
    if (next == places) next = 0;
    highs[0] = total;
    parting.next_block();
    if (!odd) aggregate = Ends::combine(suffix(next), total);
  } else {
    highs[1] = total;
    const uint32_t built = places - 1 - next;
    if (parting.middle != kNowhere)
      highs[2 + built] =
          Ends::combine((built < parting.middle ? lows : highs)[2 + built], highs[3 + built]);
    if (!odd) aggregate = window_total<Ends>(suffix(next), middle(), total);
  }
  return aggregate;
}

/// A window over pairs of keys: two windows, of the lows and of the highs. While no sample in them
/// is missing they are equal, and only that of the lows is updated.
template <template <class> class Operator, class Value, uint32_t Length>
class PairWindow {
 public:
  using Element = typename Operator<Value>::Element;

  constexpr void reset() noexcept {
    window_reset<Ends>(lows_, cursor_, Length);
    parting_.reset();
  }

  ETLMON_STEP Element push(Element element) noexcept {
    if (Length == 1) return element;
    if (!same_ends(element) || !parting_.nowhere())
      return push_apart(low_of(element), high_of(element));
    const EndElement both = window_push<Ends>(lows_, cursor_, Length, low_of(element));
    return pair_of(both, both);
  }

 private:
  using Ends = Operator<typename Lattice<Value>::End>;
  using EndElement = typename Ends::Element;

  ETLMON_COLD Element push_apart(EndElement low, EndElement high) noexcept {
    const bool parts = !same_ends(pair_of(low, high));
    const EndElement highs =
        window_push_highs<Ends>(lows_, highs_, parting_, cursor_, Length, high, parts);
    return pair_of(window_push<Ends>(lows_, cursor_, Length, low), highs);
  }

  uint32_t cursor_;
  Parting parting_;
  EndElement lows_[window_elements(Length)];
  EndElement highs_[window_elements(Length)];  ///< written before read
};

template <template <class> class Operator, uint32_t Length>
class Window<Operator<Value>, Length> : public PairWindow<Operator, Value, Length> {};

}  // namespace ETLMON_BUILD
}  // namespace etlmon
