// SPDX-License-Identifier: MIT
// The cost of windows and delays: bytes, and operations per step. Takes: a length known at run
// time. Gives: sizeof(Window<Monoid, n>) and sizeof(Delay<Value, n>), for the plan of a monitor.
// Keeps true: the sizes are the same on every target.
#pragma once

#include "etlmon/past/count.hpp"
#include "etlmon/temporal/boolean_window.hpp"
#include "etlmon/temporal/delay.hpp"
#include "etlmon/temporal/sourced.hpp"
#include "etlmon/temporal/window.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

/// Returns the most combinations in a step of a window over the last n >= 1. Long runs reach it.
constexpr uint32_t window_operations(uint32_t n) noexcept { return n == 1 ? 0 : n < 4 ? n : 4; }

/// Returns the bytes of a cursor and its values, up to the next cursor.
constexpr uint32_t storage_bytes(uint32_t values) noexcept { return (4 + values + 3) / 4 * 4; }

/// Returns sizeof(Delay<Value, n>).
template <class V>
constexpr uint32_t delay_bytes(uint32_t n) noexcept {
  return storage_bytes(n * static_cast<uint32_t>(sizeof(V)));
}

template <>
constexpr uint32_t delay_bytes<Truth>(uint32_t n) noexcept {
  return 4 + 4 * ((n + 15) / 16);
}

template <class Monoid>
struct WindowBytes {
  static constexpr uint32_t of(uint32_t n) noexcept {
    return storage_bytes(window_elements(n) *
                         static_cast<uint32_t>(sizeof(typename Monoid::Element)));
  }
};

template <template <class> class Operator, class V>
struct PairWindowBytes {
  static constexpr uint32_t of(uint32_t n) noexcept {
    using Element = typename Operator<typename Lattice<V>::End>::Element;
    return storage_bytes(2 * window_elements(n) * static_cast<uint32_t>(sizeof(Element))) +
           static_cast<uint32_t>(sizeof(Parting));
  }
};
template <template <class> class Operator>
struct WindowBytes<Operator<Value>> : PairWindowBytes<Operator, Value> {};
template <template <class> class Operator>
struct WindowBytes<Operator<Sourced>> : PairWindowBytes<Operator, Sourced> {};

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
template <>
struct WindowBytes<Until<Truth>> {
  /// Three counts, a byte per position, and one each for the last decision and result.
  static constexpr uint32_t of(uint32_t n) noexcept { return 12 + (n + 2 + 3) / 4 * 4; }
};
template <>
struct WindowBytes<Release<Truth>> : WindowBytes<Until<Truth>> {};

/// Returns sizeof(AtLeast<V, n, length>), and of its dual.
template <class V>
constexpr uint32_t count_bytes(uint32_t n, uint32_t length) noexcept {
  constexpr auto kBytes = static_cast<uint32_t>(2 * sizeof(typename Lattice<V>::End));
  if (keeps_order(n, length)) return delay_bytes<V>(length) + kBytes * length + 4;
  return storage_bytes(window_elements(length) * n * kBytes) +
         static_cast<uint32_t>(sizeof(Parting));
}

template <>
constexpr uint32_t count_bytes<Truth>(uint32_t, uint32_t length) noexcept {
  return delay_bytes<Truth>(length) + 8;
}

/// Returns sizeof(Window<Monoid, n>).
template <class Monoid>
constexpr uint32_t window_bytes(uint32_t n) noexcept {
  return WindowBytes<Monoid>::of(n);
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
