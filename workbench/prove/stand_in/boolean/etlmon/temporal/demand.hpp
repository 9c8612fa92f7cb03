// SPDX-License-Identifier: MIT
// Stands in for the runtime's demand.hpp when `etlc prove` compiles a class with --values boolean:
// the truth of a predicate or of a bool input is the proof's choice, and nothing is measured.
// Takes: what the runtime's file takes. Gives: the same names. Keeps true: all else is the text of
// the runtime's file. A Lazy is an atom by its place among those that a step makes.
#pragma once

#include "etlmon/temporal/truth.hpp"

#define Lazy LazyOfRuntime
#include_next "etlmon/temporal/demand.hpp"
#undef Lazy

namespace etlprove {

constexpr uint32_t kNoAtom = 0xffffffffu;

/// Returns the atom that the next Lazy of this step is.
uint32_t next_lazy();
/// Returns the truth of an atom at this step.
etlmon::Truth truth_of_atom(uint32_t atom);
[[noreturn]] void refuse_type();

}  // namespace etlprove

namespace etlmon {
inline namespace ETLMON_BUILD {

template <class Find>
class Lazy {
    using Result = decltype(static_cast<const Find*>(nullptr)->operator()());

public:
    explicit Lazy(Find find) noexcept : of_(find), atom_(etlprove::next_lazy()) {}
    Lazy(const Lazy&) = delete;
    Lazy& operator=(const Lazy&) = delete;

    Result operator()() const noexcept {
        if (atom_ == etlprove::kNoAtom) return of_();
        if constexpr (detail::Same<Result, Truth>::value) return etlprove::truth_of_atom(atom_);
        etlprove::refuse_type();
    }
    operator Result() const noexcept { return (*this)(); }

private:
    LazyOfRuntime<Find> of_;
    uint32_t atom_;
};

template <class Find>
Lazy(Find) -> Lazy<Find>;

namespace detail {

template <class Find>
struct IsLazy<Lazy<Find>> {
    static constexpr bool value = true;
};

}  // namespace detail
}  // namespace ETLMON_BUILD
}  // namespace etlmon
