// SPDX-License-Identifier: MIT
// Inputs of a monitor: views of embeddings, and whether they are present. Takes: arrays whose size
// the compiler checks. Gives: Vector, Point, finite(...), present(...). Keeps true: a
// default-constructed view is a missing sample; so is one with an element that is not finite, as
// decided by its bits; a view owns nothing and must not outlive its array.
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

// The number of elements of a container type: size() of a constant std::array, extent of std::span.
template <class Array, size_t Size = Array{}.size()>
constexpr size_t fixed_size(int, int) noexcept {
  return Size;
}
template <class Array, size_t Size = Array::extent>
constexpr size_t fixed_size(int, long) noexcept {
  return Size;
}

// Whether it is Dim.
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

/// A view of Dim contiguous elements: float, uint16_t (IEEE bits of a float16) or int8_t. Missing
/// by default.
template <class Element, size_t Dim>
class Vector {
 public:
  constexpr Vector() noexcept = default;
  constexpr Vector(const Element (&etlmon_elements)[Dim]) noexcept : data_(etlmon_elements) {}

  /// Views std::array<Element, Dim>, std::span<Element, Dim> and similar types, with data() and a
  /// size known at compile time, which must be Dim.
  template <class Array, class = detail::ReadsAs<Element, Array>,
            typename detail::If<detail::holds<Array, Dim>(0)>::type = 0>
  constexpr Vector(const Array& etlmon_elements) noexcept : data_(etlmon_elements.data()) {}
  // Compilers quote these lines for a std::vector or a wrong number of elements. clang-format off
  template <class Array, class = detail::ReadsAs<Element, Array>,
            typename detail::If<!detail::holds<Array, Dim>(0)>::type = 0>
  Vector(const Array&) = delete;  // not Dim elements by its type: Vector::unchecked(x.data())
  template <size_t Size, typename detail::If<Size != Dim>::type = 0>
  Vector(const Element (&)[Size]) = delete;  // not Dim elements
  // clang-format on
  /// A temporary array would be destroyed before step() reads it.
  template <class Array, class = detail::ReadsAs<Element, Array>, class = decltype(Array{}.size())>
  Vector(const Array&&) = delete;

  /// Views Dim elements at `elements`, unchecked; nullptr is a missing sample.
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

/// An embedding of Dim scalars, each kMissing if it is missing.
template <size_t Dim>
struct Point {
  float elements[Dim];
};

namespace detail {
/// Hides the origin of elements from the compiler. Under -ffinite-math-only it would take a choice
/// between a number and a NaN for the number.
ETLMON_INLINE const float* unforeseen(const float* elements) noexcept {
#if defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__
  elements = opaque(elements);
#endif
  return elements;
}
}  // namespace detail

/// Returns whether all n floats are finite.
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

/// Returns whether all n float16, given as IEEE bits, are finite.
ETLMON_INLINE bool finite(const uint16_t* x, size_t n) noexcept {
  uint32_t worst = 0;
  for (size_t i = 0; i < n; ++i) {
    // Adding one to the exponent field carries into bit 15 if and only if all its bits are set.
    worst |= (x[i] & 0x7c00u) + 0x0400u;
  }
  return (worst & 0x8000u) == 0;
}

ETLMON_INLINE constexpr bool finite(const int8_t*, size_t) noexcept { return true; }

/// Returns whether the embedding is present and all its elements are finite.
template <class Element, size_t Dim>
ETLMON_INLINE bool present(const Vector<Element, Dim>& x) noexcept {
  return x.present() && finite(x.data(), Dim);
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
