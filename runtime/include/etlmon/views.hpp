// SPDX-License-Identifier: MIT
// What a user hands to Monitor::step: views of embeddings, and the test of what counts as present.
// Takes: arrays whose size the compiler checks. Gives: Vector, Point, finite(...), present(...).
// Keeps true: a default-constructed view is a missing sample; one with an element that is not
// finite counts as missing, decided by bits; a view owns nothing and must not outlive what it
// views.
#pragma once

#include "etlmon/scalars.hpp"
#if defined(ETLMON_VECTORS)
#include "etlmon/vectors/pack.hpp"
#endif

namespace etlmon {
inline namespace ETLMON_BUILD {

namespace detail {

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

// Whether it is D.
template <class A, size_t D, typename If<fixed_size<A>(0, 0) == D>::type = 0>
constexpr bool holds(int) noexcept {
  return true;
}
template <class A, size_t D>
constexpr bool holds(long) noexcept {
  return false;
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
            typename detail::If<detail::holds<A, D>(0)>::type = 0>
  constexpr Vector(const A& elements) noexcept : data_(elements.data()) {}
  // What compilers quote where a std::vector, or another number of elements, is given.
  // clang-format off
  template <class A, class = detail::ReadsAs<T, A>,
            typename detail::If<!detail::holds<A, D>(0)>::type = 0>
  Vector(const A&) = delete;  // not D elements by its type: Vector::unchecked(x.data()) if it has D
  template <size_t N, typename detail::If<N != D>::type = 0>
  Vector(const T (&)[N]) = delete;  // not D elements
  // clang-format on
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

namespace detail {
/// Elements of which the compiler does not know where they come from. Where NaN is assumed away it
/// must not conclude from a choice between a number and a NaN that it was the number.
ETLMON_INLINE const float* unforeseen(const float* elements) noexcept {
#if defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__
  elements = opaque(elements);
#endif
  return elements;
}
}  // namespace detail

/// Every one of n floats is finite.
ETLMON_INLINE bool finite(const float* x, size_t n) noexcept {
  size_t i = 0;
#if defined(ETLMON_VECTORS)
  if (!detail::finite_packs(x, n, i)) return false;
#endif
  for (; i < n; ++i) {
    if (!is_finite(x[i])) return false;
  }
  return true;
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

}  // namespace ETLMON_BUILD
}  // namespace etlmon
