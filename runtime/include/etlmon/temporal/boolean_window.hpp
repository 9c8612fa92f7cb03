// SPDX-License-Identifier: MIT
// Windows over truth values. Takes: a truth value per step, or both operands of since or until.
// Gives: the results of the general Window. Keeps true: constant time per step. The state is the
// age of the last value that matters, two counters for any length; of an until, which is evaluated
// at its oldest position, a byte per position.
#pragma once

#include "etlmon/temporal/delay.hpp"
#include "etlmon/temporal/monoid.hpp"
#include "etlmon/temporal/truth.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {
namespace detail {

/// Counts the steps since something last happened, up to Length, where it has left the window.
template <uint32_t Length>
class Age {
 public:
  constexpr void reset() noexcept { steps_ = Length; }
  void next(bool happened) noexcept {
    steps_ = happened ? 0 : steps_ + (steps_ < Length ? 1u : 0u);
  }
  /// Removes it from the window.
  constexpr void forget() noexcept { steps_ = Length; }
  bool within() const noexcept { return steps_ < Length; }

 private:
  uint32_t steps_;
};

/// The dual of Wrapped: operands and result are negated.
template <class Wrapped>
class Dual {
 public:
  using Element = typename Wrapped::Element;

  constexpr void reset() noexcept { failed_.reset(); }
  Element push(Span<Truth> now) noexcept {
    return {negate(failed_.push({negate(now.value), negate(now.guard)}).value)};
  }

 private:
  Wrapped failed_;
};

}  // namespace detail

/// Or over the last Length values.
template <uint32_t Length>
class Window<Greatest<Truth>, Length> {
 public:
  constexpr void reset() noexcept {
    low_.reset();
    high_.reset();
  }

  Truth push(Truth now) noexcept {
    low_.next(now.low);
    high_.next(now.high);
    return {low_.within(), high_.within()};
  }

 private:
  detail::Age<Length> low_;   ///< age of the last surely true value
  detail::Age<Length> high_;  ///< age of the last possibly true value
};

/// And over the last Length values.
template <uint32_t Length>
class Window<Least<Truth>, Length> {
 public:
  constexpr void reset() noexcept { failed_.reset(); }
  Truth push(Truth now) noexcept { return negate(failed_.push(negate(now))); }

 private:
  Window<Greatest<Truth>, Length> failed_;
};

/// f S g over the last Length positions: true if f has held since the newest g.
template <uint32_t Length>
class Window<Since<Truth>, Length> {
 public:
  struct Element {
    Truth value;
  };

  constexpr void reset() noexcept {
    low_.reset();
    high_.reset();
  }

  Element push(Span<Truth> now) noexcept {
    if (!now.guard.low) low_.forget();
    if (!now.guard.high) high_.forget();
    low_.next(now.value.low);
    high_.next(now.value.high);
    return {{low_.within(), high_.within()}};
  }

 private:
  detail::Age<Length> low_;
  detail::Age<Length> high_;
};

/// The dual of Since.
template <uint32_t Length>
class Window<Trigger<Truth>, Length> : public detail::Dual<Window<Since<Truth>, Length>> {};

/// f U g at the oldest of the last Length positions. The first position from there on where g
/// holds, or where neither f nor g holds, decides; before it f holds and g does not. A decision
/// applies to all undecided positions up to its own, so only changes of the result are stored. The
/// ends of a truth value are bits, 1 for low and 2 for high, and no branch depends on them, since
/// they are unpredictable.
template <uint32_t Length>
class Window<Until<Truth>, Length> {
  static_assert(Length >= 1 && Length <= 0x7fffffffu, "a window holds at least this step");

 public:
  using Element = typename Window<Since<Truth>, Length>::Element;

  constexpr void reset() noexcept {
    cursor_ = 0;
    open_ = Length - 1;
    more_open_ = 0;
    decided_ = answer_ = 0;
    for (uint8_t& turns : turns_) turns = 0;
  }

  ETLMON_STEP Element push(Span<Truth> now) noexcept {
    const uint32_t slot = cursor_, g = ends(now.value);
    const uint32_t decides = g | (ends(now.guard) ^ 3u), turns = decides & (g ^ decided_);
    decided_ = static_cast<uint8_t>(decided_ ^ turns);
    turns_[slot] = 0;
    cursor_ = slot + 1 == Length ? 0 : slot + 1;

    uint32_t leaving = 0;  // ends that are undecided at the oldest position
    if (more_open_ == 0 && (decides == 0 || decides == 3)) {
      turns_[first_open(slot, open_ + 1)] = static_cast<uint8_t>(turns);
      leaving = close(open_, decides) * 3;
    } else {
      leaving = push_apart(slot, decides, turns);
    }
    answer_ = static_cast<uint8_t>(answer_ ^ turns_[cursor_]);
    const uint32_t answer = answer_ & ~leaving;
    return {{(answer & 1u) != 0, (answer & 2u) != 0}};
  }

 private:
  static uint32_t ends(Truth t) noexcept { return (t.low ? 1u : 0u) | (t.high ? 2u : 0u); }

  /// Returns the slot of the first of `open` positions, the last of which is in `slot`.
  static uint32_t first_open(uint32_t slot, uint32_t open) noexcept {
    const uint32_t first = slot + 1 - open;
    return first + (Length & (0u - (first >> 31)));
  }

  /// Adds an open position, or closes all. Returns 1 if the oldest leaves the window undecided.
  static uint32_t close(uint32_t& open, uint32_t decides) noexcept {
    const uint32_t left = (open + 1) & ((decides & 1u) - 1u), leaves = left == Length ? 1u : 0u;
    open = left - leaves;
    return leaves;
  }

  /// With a missing sample in the window, the ends may be decided at different positions.
  ETLMON_COLD uint32_t push_apart(uint32_t slot, uint32_t decides, uint32_t turns) noexcept {
    uint32_t high = open_ + more_open_;
    uint8_t& of_low = turns_[first_open(slot, open_ + 1)];
    of_low = static_cast<uint8_t>(of_low | (turns & 1u));
    uint8_t& of_high = turns_[first_open(slot, high + 1)];
    of_high = static_cast<uint8_t>(of_high | (turns & 2u));
    const uint32_t leaving = close(open_, decides) | close(high, decides >> 1) << 1;
    more_open_ = high - open_;
    return leaving;
  }

  uint32_t cursor_;        ///< slot of the next position, and of the oldest
  uint32_t more_open_;     ///< additional open positions of the high end, modulo 2^32
  uint8_t turns_[Length];  ///< ends whose result differs from that of the slot before
  uint8_t decided_;        ///< last decisions
  uint8_t answer_;         ///< result at the oldest position, or before it while it is undecided
  uint32_t open_;          ///< newest positions whose low end is undecided
};

/// The dual of Until.
template <uint32_t Length>
class Window<Release<Truth>, Length> : public detail::Dual<Window<Until<Truth>, Length>> {};

/// A delay of truth values, 16 per word.
template <uint32_t Length>
class Delay<Truth, Length> {
  static_assert(Length >= 1, "a delay by nothing is the value itself");

 public:
  constexpr void reset(Truth fill) noexcept {
    cursor_ = 0;
    const uint32_t word = (fill.low ? 0x55555555u : 0u) | (fill.high ? 0xaaaaaaaau : 0u);
    for (uint32_t& pairs : pairs_) pairs = word;
  }

  Truth push(Truth value) noexcept {
    uint32_t& pairs = pairs_[cursor_ / 16];
    const uint32_t shift = cursor_ % 16 * 2;
    const uint32_t past = pairs >> shift;
    pairs =
        (pairs & ~(3u << shift)) | (value.low ? 1u << shift : 0u) | (value.high ? 2u << shift : 0u);
    cursor_ = cursor_ + 1 == Length ? 0 : cursor_ + 1;
    return {(past & 1u) != 0, (past & 2u) != 0};
  }

 private:
  uint32_t cursor_;
  uint32_t pairs_[(Length + 15) / 16];  ///< low in even bits, high in odd bits
};

}  // namespace ETLMON_BUILD
}  // namespace etlmon
