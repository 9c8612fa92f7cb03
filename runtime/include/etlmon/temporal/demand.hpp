// SPDX-License-Identifier: MIT
// Measuring only what a verdict still depends on.
// Takes: a way to find a value out. Gives: values that are found out when somebody first asks in a
// step, and "and", "or" and "not" of such values, which ask their operands from left to right and
// stop at the first that decides. Keeps true: a value is found out at most once; what comes out is
// the min, max or negation of all operands, asked or not: kNo decides a min and kYes a max whatever
// the others are.
#pragma once

#include "etlmon/temporal/truth.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

/// What `find()` gives, found out on the first call. Lives in one step and is not copied.
template <class Find>
class Lazy {
  using Result = decltype(static_cast<const Find*>(nullptr)->operator()());

 public:
  explicit Lazy(Find find) noexcept : find_(find) {}
  Lazy(const Lazy&) = delete;
  Lazy& operator=(const Lazy&) = delete;

  Result operator()() const noexcept {
    if (!found_) {
      value_ = find_();
      found_ = true;
    }
    return value_;
  }
  operator Result() const noexcept { return (*this)(); }

 private:
  const Find find_;
  mutable Result value_{};
  mutable bool found_ = false;
};

template <class Find>
Lazy(Find) -> Lazy<Find>;

namespace detail {

/// What a combination keeps of an operand: a reference to a variable, a temporary itself.
template <class A>
struct Kept {
  using Type = const A;
};
template <class A>
struct Kept<A&> {
  using Type = const A&;
};

template <class A, class B>
struct Both {
  typename Kept<A>::Type first;
  typename Kept<B>::Type second;
  operator Truth() const noexcept {
    const Truth known = first;
    if (!known.high) return kNo;
    return min_of(known, static_cast<Truth>(second));
  }
};

template <class A, class B>
struct Either {
  typename Kept<A>::Type first;
  typename Kept<B>::Type second;
  operator Truth() const noexcept {
    const Truth known = first;
    if (known.low) return kYes;
    return max_of(known, static_cast<Truth>(second));
  }
};

template <class A>
struct Negation {
  typename Kept<A>::Type of;
  operator Truth() const noexcept { return negate(static_cast<Truth>(of)); }
};

template <class A>
struct IsLazy {
  static constexpr bool value = false;
};
template <class Find>
struct IsLazy<Lazy<Find>> {
  static constexpr bool value = true;
};
template <class A, class B>
struct IsLazy<Both<A, B>> {
  static constexpr bool value = true;
};
template <class A, class B>
struct IsLazy<Either<A, B>> {
  static constexpr bool value = true;
};
template <class A>
struct IsLazy<Negation<A>> {
  static constexpr bool value = true;
};
template <class A>
struct IsLazy<A&> : IsLazy<A> {};
template <class A>
struct IsLazy<const A> : IsLazy<A> {};

template <bool>
struct Where {};
template <>
struct Where<true> {
  using Type = int;
};

}  // namespace detail

/// `a`, then `b` unless a decides; the same for more.
template <class A, class B,
          typename detail::Where<detail::IsLazy<A>::value || detail::IsLazy<B>::value>::Type = 0>
ETLMON_INLINE detail::Both<A, B> min_of(A&& a, B&& b) noexcept {
  return {a, b};
}
template <class A, class B,
          typename detail::Where<detail::IsLazy<A>::value || detail::IsLazy<B>::value>::Type = 0>
ETLMON_INLINE detail::Either<A, B> max_of(A&& a, B&& b) noexcept {
  return {a, b};
}
template <class A, typename detail::Where<detail::IsLazy<A>::value>::Type = 0>
ETLMON_INLINE detail::Negation<A> negate(A&& a) noexcept {
  return {a};
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
