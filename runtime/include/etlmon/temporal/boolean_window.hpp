// SPDX-License-Identifier: MIT
// Windows over truth values.
// Takes: one truth value a step, or the two sides of a since. Gives: what Window gives for any
// value type. Keeps true: the same results as the general window (tested against it), in two
// counters whatever N: of a yes and no only the age of the last one that matters is remembered.
#pragma once

#include "etlmon/temporal/delay.hpp"
#include "etlmon/temporal/truth.hpp"
#include "etlmon/temporal/window.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {
namespace detail {

/// Steps since something last happened, at most N: then it is out of the window.
template <uint32_t N>
class Age {
 public:
  void reset() noexcept { steps_ = N; }
  void next(bool happened) noexcept { steps_ = happened ? 0 : steps_ + (steps_ < N ? 1u : 0u); }
  /// It no longer counts.
  void forget() noexcept { steps_ = N; }
  bool within() const noexcept { return steps_ < N; }

 private:
  uint32_t steps_;
};

}  // namespace detail

/// Or over the last N: some step was true.
template <uint32_t N>
class Window<Greatest<Truth>, N> {
 public:
  void reset() noexcept {
    low_.reset();
    high_.reset();
  }

  Truth push(Truth now) noexcept {
    low_.next(now.low);
    high_.next(now.high);
    return {low_.within(), high_.within()};
  }

 private:
  detail::Age<N> low_;   ///< of the last step that was surely true
  detail::Age<N> high_;  ///< of the last one that perhaps was
};

/// And over the last N.
template <uint32_t N>
class Window<Least<Truth>, N> {
 public:
  void reset() noexcept { failed_.reset(); }
  Truth push(Truth now) noexcept { return negate(failed_.push(negate(now))); }

 private:
  Window<Greatest<Truth>, N> failed_;
};

/// f S g over the last N: the newest g counts, while f has held since.
template <uint32_t N>
class Window<Since<Truth>, N> {
 public:
  struct Element {
    Truth value;
  };

  void reset() noexcept {
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
  detail::Age<N> low_;
  detail::Age<N> high_;
};

/// The dual of Since.
template <uint32_t N>
class Window<Trigger<Truth>, N> {
 public:
  using Element = typename Window<Since<Truth>, N>::Element;

  void reset() noexcept { failed_.reset(); }
  Element push(Span<Truth> now) noexcept {
    return {negate(failed_.push({negate(now.value), negate(now.guard)}).value)};
  }

 private:
  Window<Since<Truth>, N> failed_;
};

namespace detail {
constexpr uint32_t kAgeBytes = 2 * sizeof(uint32_t);
}
template <>
struct WindowBytes<Greatest<Truth>> {
  static constexpr uint32_t of(uint32_t) noexcept { return detail::kAgeBytes; }
};
template <>
struct WindowBytes<Least<Truth>> : WindowBytes<Greatest<Truth>> {};
template <>
struct WindowBytes<Since<Truth>> : WindowBytes<Greatest<Truth>> {};
template <>
struct WindowBytes<Trigger<Truth>> : WindowBytes<Greatest<Truth>> {};

/// A delay of truth values, sixteen to a word.
template <uint32_t N>
class Delay<Truth, N> {
  static_assert(N >= 1, "a delay by nothing is the value itself");

 public:
  void reset(Truth fill) noexcept {
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
    cursor_ = cursor_ + 1 == N ? 0 : cursor_ + 1;
    return {(past & 1u) != 0, (past & 2u) != 0};
  }

 private:
  uint32_t cursor_;
  uint32_t pairs_[(N + 15) / 16];  ///< low in the even bits, high in the odd ones
};

template <>
constexpr uint32_t delay_bytes<Truth>(uint32_t n) noexcept {
  return 4 + 4 * ((n + 15) / 16);
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
