// SPDX-License-Identifier: MIT
// Evaluation on demand: measures only what a verdict still depends on. Takes: a function that
// computes a value. Gives: values that are computed at their first use in a step, and "and", "or"
// and "not" of them, which evaluate operands from left to right and stop at the first that decides.
// Keeps true: a value is computed at most once; the result is the min, max or negation of all
// operands, since kNo decides a min and kYes a max.
#pragma once

#include "etlmon/temporal/truth.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

/// The result of `find()`, computed at the first use. Lives in one step and is not copied.
template <class Find>
class Lazy {
  using Result = decltype(static_cast<const Find*>(nullptr)->operator()());

 public:
  explicit Lazy(Find etlmon_find) noexcept : find_(etlmon_find) {}
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

/// How a combination stores an operand: a variable by reference, a temporary by value.
template <class Operand>
struct Kept {
  using Type = const Operand;
};
template <class Operand>
struct Kept<Operand&> {
  using Type = const Operand&;
};

template <class Left, class Right>
struct Both {
  typename Kept<Left>::Type first;
  typename Kept<Right>::Type second;
  operator Truth() const noexcept {
    const Truth known = first;
    if (!known.high) return kNo;
    return min_of(known, static_cast<Truth>(second));
  }
};

template <class Left, class Right>
struct Either {
  typename Kept<Left>::Type first;
  typename Kept<Right>::Type second;
  operator Truth() const noexcept {
    const Truth known = first;
    if (known.low) return kYes;
    return max_of(known, static_cast<Truth>(second));
  }
};

template <class Operand>
struct Negation {
  typename Kept<Operand>::Type of;
  operator Truth() const noexcept { return negate(static_cast<Truth>(of)); }
};

template <class Operand>
struct IsLazy {
  static constexpr bool value = false;
};
template <class Find>
struct IsLazy<Lazy<Find>> {
  static constexpr bool value = true;
};
template <class Left, class Right>
struct IsLazy<Both<Left, Right>> {
  static constexpr bool value = true;
};
template <class Left, class Right>
struct IsLazy<Either<Left, Right>> {
  static constexpr bool value = true;
};
template <class Operand>
struct IsLazy<Negation<Operand>> {
  static constexpr bool value = true;
};
template <class Operand>
struct IsLazy<Operand&> : IsLazy<Operand> {};
template <class Operand>
struct IsLazy<const Operand> : IsLazy<Operand> {};

template <bool>
struct Where {};
template <>
struct Where<true> {
  using Type = int;
};

}  // namespace detail

/// Evaluates `a`, then `b` unless a decides; likewise for more operands.
template <
    class Left, class Right,
    typename detail::Where<detail::IsLazy<Left>::value || detail::IsLazy<Right>::value>::Type = 0>
ETLMON_INLINE detail::Both<Left, Right> min_of(Left&& a, Right&& b) noexcept {
  return {a, b};
}
template <
    class Left, class Right,
    typename detail::Where<detail::IsLazy<Left>::value || detail::IsLazy<Right>::value>::Type = 0>
ETLMON_INLINE detail::Either<Left, Right> max_of(Left&& a, Right&& b) noexcept {
  return {a, b};
}
template <class Operand, typename detail::Where<detail::IsLazy<Operand>::value>::Type = 0>
ETLMON_INLINE detail::Negation<Operand> negate(Operand&& a) noexcept {
  return {a};
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
