// SPDX-License-Identifier: MIT
// Stands in for the runtime's demand.hpp when `etlc prove` compiles a class: a truth that is
// measured is the atom whose turn it is in the step, and nothing is measured. Takes: what the
// runtime's file takes. Gives: the same names. Keeps true: "and" and "or" evaluate both operands,
// whose min and max are the same.
#pragma once

#include "etlmon/temporal/truth.hpp"

namespace etlprove {

/// Returns the atom whose turn it is.
etlmon::Truth next_truth();

}  // namespace etlprove

namespace etlmon {
inline namespace ETLMON_BUILD {

template <class Find>
class Lazy {
    using Result = decltype(static_cast<const Find*>(nullptr)->operator()());
    static constexpr bool kIsAtom = detail::Same<Result, Truth>::value;

public:
    explicit Lazy(Find find) noexcept : find_(find) {
        if constexpr (kIsAtom) value_ = etlprove::next_truth();
    }
    Lazy(const Lazy&) = delete;
    Lazy& operator=(const Lazy&) = delete;

    Result operator()() const noexcept {
        if constexpr (kIsAtom) return value_;
        return find_();
    }
    operator Result() const noexcept { return (*this)(); }

private:
    const Find find_;
    Result value_{};
};

template <class Find>
Lazy(Find) -> Lazy<Find>;

namespace detail {

template <class Operand>
struct IsLazy {
    static constexpr bool value = false;
};
template <class Find>
struct IsLazy<Lazy<Find>> {
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

template <
    class Left, class Right,
    typename detail::Where<detail::IsLazy<Left>::value || detail::IsLazy<Right>::value>::Type = 0>
Truth min_of(Left&& a, Right&& b) noexcept {
    return min_of(static_cast<Truth>(a), static_cast<Truth>(b));
}
template <
    class Left, class Right,
    typename detail::Where<detail::IsLazy<Left>::value || detail::IsLazy<Right>::value>::Type = 0>
Truth max_of(Left&& a, Right&& b) noexcept {
    return max_of(static_cast<Truth>(a), static_cast<Truth>(b));
}
template <class Operand, typename detail::Where<detail::IsLazy<Operand>::value>::Type = 0>
Truth negate(Operand&& a) noexcept {
    return negate(static_cast<Truth>(a));
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
