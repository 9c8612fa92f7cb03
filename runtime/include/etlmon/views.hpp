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

template <class Array>
const Array& some() noexcept;

// How many elements a container type always has: std::array by the size() of a constant, std::span
// by its extent.
template <class Array, size_t Size = Array{}.size()>
constexpr size_t fixed_size(int, int) noexcept {
  return Size;
}
template <class Array, size_t Size = Array::extent>
constexpr size_t fixed_size(int, long) noexcept {
  return Size;
}

// Whether it is D.
template <class Array, size_t Dim, typename If<fixed_size<Array>(0, 0) == Dim>::type = 0>
constexpr bool holds(int) noexcept {
  return true;
}
template <class Array, size_t Dim>
constexpr bool holds(long) noexcept {
  return false;
}

template <class Element>
void reads(const Element*) noexcept;
template <class Element, class Array>
using ReadsAs = decltype(reads<Element>(some<Array>().data()));

}  // namespace detail

/// A view of D contiguous elements: float, uint16_t (the IEEE bits of a float16) or int8_t.
/// Default: missing.
template <class Element, size_t Dim>
class Vector {
 public:
  constexpr Vector() noexcept = default;
  constexpr Vector(const Element (&elements)[Dim]) noexcept : data_(elements) {}

  /// std::array<T, D>, std::span<T, D> and their like: data() and a size known to the compiler,
  /// which must be D.
  template <class Array, class = detail::ReadsAs<Element, Array>,
            typename detail::If<detail::holds<Array, Dim>(0)>::type = 0>
  constexpr Vector(const Array& elements) noexcept : data_(elements.data()) {}
  // What compilers quote where a std::vector, or another number of elements, is given.
  // clang-format off
  template <class Array, class = detail::ReadsAs<Element, Array>,
            typename detail::If<!detail::holds<Array, Dim>(0)>::type = 0>
  Vector(const Array&) = delete;  // not D elements by its type: Vector::unchecked(x.data()) if it has D
  template <size_t Size, typename detail::If<Size != Dim>::type = 0>
  Vector(const Element (&)[Size]) = delete;  // not D elements
  // clang-format on
  /// A temporary array would be gone before step() reads it.
  template <class Array, class = detail::ReadsAs<Element, Array>, class = decltype(Array{}.size())>
  Vector(const Array&&) = delete;

  /// D elements at `elements`, which nothing checks; nullptr is a missing sample.
  static constexpr Vector unchecked(const Element* elements) noexcept {
    Vector view;
    view.data_ = elements;
    return view;
  }

  constexpr bool present() const noexcept { return data_ != nullptr; }
  constexpr const Element* data() const noexcept { return data_; }

 private:
  const Element* data_ = nullptr;
};

/// D scalars as an embedding; each kMissing where it is missing.
template <size_t Dim>
struct Point {
  float elements[Dim];
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
template <class Element, size_t Dim>
ETLMON_INLINE bool present(const Vector<Element, Dim>& x) noexcept {
  return x.present() && finite(x.data(), Dim);
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
