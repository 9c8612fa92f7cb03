// SPDX-License-Identifier: MIT
// What a user hands to Monitor::step: views of embeddings, flags, and the test of what counts as
// present. Takes: arrays whose size the compiler checks, bools, floats. Gives: Vector, Flag,
// kMissing, present(...). Keeps true: a default-constructed input is missing; a sample with an
// element that is not finite, or a scalar outside its range, counts as missing, decided by bits; a
// view owns nothing and must not outlive what it views.
#pragma once

#include "etlmon/bits.hpp"
#include "etlmon/pack.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

namespace detail {

template <class A, class B>
struct Same {
  static constexpr bool value = false;
};
template <class A>
struct Same<A, A> {
  static constexpr bool value = true;
};
template <bool Condition>
struct If {};
template <>
struct If<true> {
  using type = int;
};
template <class A>
const A& some() noexcept;

// How many elements a container type always has: std::array by the size() of a constant, std::span
// by its extent.
template <class A, size_t N = A{}.size()>
constexpr size_t fixed_size(int, int) noexcept {
  return N;
}
template <class A, size_t N = A::extent>
constexpr size_t fixed_size(int, long) noexcept {
  return N;
}

template <class T>
void reads(const T*) noexcept;
template <class T, class A>
using ReadsAs = decltype(reads<T>(some<A>().data()));

}  // namespace detail

/// A view of D contiguous elements: float, uint16_t (the IEEE bits of a float16) or int8_t.
/// Default: missing.
template <class T, size_t D>
class Vector {
 public:
  constexpr Vector() noexcept = default;
  constexpr Vector(const T (&elements)[D]) noexcept : data_(elements) {}

  /// std::array<T, D>, std::span<T, D> and their like: data() and a size known to the compiler,
  /// which must be D.
  template <class A, class = detail::ReadsAs<T, A>,
            typename detail::If<detail::fixed_size<A>(0, 0) == D>::type = 0>
  constexpr Vector(const A& elements) noexcept : data_(elements.data()) {}
  /// A temporary array would be gone before step() reads it.
  template <class A, class = detail::ReadsAs<T, A>, class = decltype(A{}.size())>
  Vector(const A&&) = delete;

  /// D elements at `elements`, which nothing checks; nullptr is a missing sample.
  static constexpr Vector unchecked(const T* elements) noexcept {
    Vector view;
    view.data_ = elements;
    return view;
  }

  constexpr bool present() const noexcept { return data_ != nullptr; }
  constexpr const T* data() const noexcept { return data_; }

 private:
  const T* data_ = nullptr;
};

/// D scalars as an embedding; each kMissing where it is missing.
template <size_t D>
struct Point {
  float elements[D];
};

/// A bool that may be missing. Only a bool converts to it: an int or a pointer is more often a
/// mistake than a flag.
class Flag {
 public:
  constexpr Flag() noexcept = default;
  template <class B, typename detail::If<detail::Same<B, bool>::value>::type = 0>
  constexpr Flag(B on) noexcept : state_(on ? kOn : kOff) {}

  constexpr bool present() const noexcept { return state_ != kNone; }
  constexpr bool value() const noexcept { return state_ == kOn; }  ///< false where it is missing

 private:
  static constexpr uint8_t kOff = 0, kOn = 1, kNone = 2;
  uint8_t state_ = kNone;
};

namespace detail {
/// Elements of which the compiler does not know where they come from. Where NaN is assumed away it
/// must not conclude from a choice between a number and a NaN that it was the number.
ETLMON_INLINE const float* unforeseen(const float* elements) noexcept {
#if defined(__GNUC__) && defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__
  __asm__("" : "+r"(elements) : : "memory");
#endif
  return elements;
}
}  // namespace detail

#if defined(ETLMON_HAS_PACKS)
namespace detail {
/// Bits that have their sign set where one of four floats is not finite: one more carries an
/// exponent of ones into it.
ETLMON_INLINE PackBits not_finite(const float* x) noexcept {
  typedef uint32_t PackExponents __attribute__((vector_size(16)));
  PackExponents bits;
  copy_bytes(&bits, x, sizeof bits);
  return reinterpret_cast<PackBits>((bits & kInfinityBits) + 0x00800000u);
}
}  // namespace detail
#endif

/// Every one of n floats is finite.
ETLMON_INLINE bool finite(const float* x, size_t n) noexcept {
  size_t i = 0;
  bool all = true;
#if defined(ETLMON_HAS_PACKS)
  detail::PackBits a{}, b{}, c{}, d{};
  for (; i + 16 <= n; i += 16) {
    a |= detail::not_finite(x + i);
    b |= detail::not_finite(x + i + 4);
    c |= detail::not_finite(x + i + 8);
    d |= detail::not_finite(x + i + 12);
  }
  for (; i + 4 <= n; i += 4) a |= detail::not_finite(x + i);
  a |= b | c | d;
  all = (a[0] | a[1] | a[2] | a[3]) >= 0;
#endif
  for (; i < n; ++i) {
    if (!is_finite(x[i])) return false;
  }
  return all;
}

/// Every one of n float16, given as their IEEE bits, is finite.
ETLMON_INLINE bool finite(const uint16_t* x, size_t n) noexcept {
  uint32_t worst = 0;
  for (size_t i = 0; i < n; ++i) {
    // Adding one to the exponent field carries into bit 15 exactly where all its bits are set.
    worst |= (x[i] & 0x7c00u) + 0x0400u;
  }
  return (worst & 0x8000u) == 0;
}

ETLMON_INLINE constexpr bool finite(const int8_t*, size_t) noexcept { return true; }

/// The embedding is there and all of it is finite.
template <class T, size_t D>
ETLMON_INLINE bool present(const Vector<T, D>& x) noexcept {
  return x.present() && finite(x.data(), D);
}

ETLMON_INLINE constexpr bool present(const Flag& x) noexcept { return x.present(); }

/// The scalar; kMissing unless it is finite.
ETLMON_INLINE float accept(const float& x) noexcept {
  return detail::from_bits(is_finite(x) ? detail::observe(x) : detail::kMissingBits);
}

/// The scalar; kMissing unless it is finite and in [low, high]. Either bound may be infinite.
ETLMON_INLINE float accept(const float& x, const float& low, const float& high) noexcept {
  constexpr int32_t kMost = static_cast<int32_t>(detail::kInfinityBits) - 1;
  const int32_t from = detail::ordered(detail::observe(low)),
                to = detail::ordered(detail::observe(high));
  const int32_t at = detail::ordered(detail::observe(x));  // of a NaN beyond the infinities
  const bool inside = (from < -kMost ? -kMost : from) <= at && at <= (to > kMost ? kMost : to);
  return detail::from_bits(inside ? detail::observe(x) : detail::kMissingBits);
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
