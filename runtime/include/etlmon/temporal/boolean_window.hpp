// SPDX-License-Identifier: MIT
// Windows over truth values.
// Takes: one truth value a step, or the two sides of a since or an until. Gives: what Window gives
// for any value type. Keeps true: the same results as the general window, in constant time a step.
// Of a yes and no only the age of the last one that matters is remembered, in two counters whatever
// N; of an until, which is asked at its oldest position, a byte a position.
#pragma once

#include "etlmon/temporal/delay.hpp"
#include "etlmon/temporal/monoid.hpp"
#include "etlmon/temporal/truth.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {
namespace detail {

/// Steps since something last happened, at most N: then it is out of the window.
template <uint32_t Length>
class Age {
 public:
  constexpr void reset() noexcept { steps_ = Length; }
  void next(bool happened) noexcept {
    steps_ = happened ? 0 : steps_ + (steps_ < Length ? 1u : 0u);
  }
  /// It no longer counts.
  constexpr void forget() noexcept { steps_ = Length; }
  bool within() const noexcept { return steps_ < Length; }

 private:
  uint32_t steps_;
};

/// What fails where W holds: both sides and the answer are negated.
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

/// Or over the last N: some step was true.
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
  detail::Age<Length> low_;   ///< of the last step that was surely true
  detail::Age<Length> high_;  ///< of the last one that perhaps was
};

/// And over the last N.
template <uint32_t Length>
class Window<Least<Truth>, Length> {
 public:
  constexpr void reset() noexcept { failed_.reset(); }
  Truth push(Truth now) noexcept { return negate(failed_.push(negate(now))); }

 private:
  Window<Greatest<Truth>, Length> failed_;
};

/// f S g over the last N: the newest g counts, while f has held since.
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

/// f U g at the oldest of the last N. The first position from there on where g holds, or where
/// neither f nor g does, decides; before it f holds and g does not. Each decision is about a run of
/// positions up to its own, so it is enough to keep where the answer turns. The ends of a truth are
/// bits here, 1 the low one and 2 the high one; and nothing branches on them: signs of distances
/// are what no processor predicts.
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

    uint32_t leaving = 0;  // ends that nothing has decided about the oldest position
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

  /// The slot of the first of `open` positions, of which the last is in `slot`.
  static uint32_t first_open(uint32_t slot, uint32_t open) noexcept {
    const uint32_t first = slot + 1 - open;
    return first + (Length & (0u - (first >> 31)));
  }

  /// One more is open, or none any more; 1 where the oldest leaves the window open.
  static uint32_t close(uint32_t& open, uint32_t decides) noexcept {
    const uint32_t left = (open + 1) & ((decides & 1u) - 1u), leaves = left == Length ? 1u : 0u;
    open = left - leaves;
    return leaves;
  }

  /// Where a missing sample is in the window, the ends may be decided at different positions.
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

  uint32_t cursor_;        ///< slot of the next position; it is the oldest one's
  uint32_t more_open_;     ///< so many more are open for the high end, modulo 2^32
  uint8_t turns_[Length];  ///< ends whose answer is not that of the slot before
  uint8_t decided_;        ///< the last decisions
  uint8_t answer_;         ///< at the oldest position; while that is open, at the one before
  uint32_t open_;  ///< positions, the newest ones, about which nothing has decided the low end
};

/// The dual of Until.
template <uint32_t Length>
class Window<Release<Truth>, Length> : public detail::Dual<Window<Until<Truth>, Length>> {};

/// A delay of truth values, sixteen to a word.
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
  uint32_t pairs_[(Length + 15) / 16];  ///< low in the even bits, high in the odd ones
};

}  // namespace ETLMON_BUILD
}  // namespace etlmon
