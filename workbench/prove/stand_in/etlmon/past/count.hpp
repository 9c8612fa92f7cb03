// SPDX-License-Identifier: MIT
// Stands in for a part of the runtime's count.hpp when `etlc prove` compiles a class: the merge of
// two sorted lists, which compares values, is replaced by mins and maxes with the same result, and
// so are values in order and counters of truths. Windows of such lists are the runtime's.
#pragma once

#define AtLeast AtLeastOfRuntime
#define AllBut AllButOfRuntime
#include_next "etlmon/past/count.hpp"
#undef AtLeast
#undef AllBut

#include "etlmon/temporal/boolean_window.hpp"
#include "etlmon/temporal/sourced.hpp"

namespace etlprove {

template <uint32_t n>
struct Nth {
    template <class Value>
    struct Of : etlmon::Nth<n>::template Of<Value> {
        using Element = etlmon::GreatestFew<Value, n>;
        /// The k-th greatest of both: for some i, the i-th of one and the (k - i)-th of the other
        /// are that great.
        static Element combine(const Element& older, const Element& newer) noexcept {
            Element result{};
            for (uint32_t k = 0; k < n; ++k) {
                Value best = max_of(older.values[k], newer.values[k]);
                for (uint32_t i = 0; i < k; ++i)
                    best = max_of(best, min_of(older.values[i], newer.values[k - 1 - i]));
                result.values[k] = best;
            }
            return result;
        }
    };
};

template <class Few, uint32_t n, uint32_t Length>
class AtLeastOfFew {
public:
    constexpr void reset() noexcept { window_.reset(); }
    template <class Value>
    Value push(Value value) noexcept {
        return window_.push(Few::at(value)).values[n - 1];
    }

private:
    etlmon::Window<Few, Length> window_;
};

/// The nth greatest of the last values.
template <class Value, uint32_t n, uint32_t Length>
class AtLeastOfAll {
    using Lattice = etlmon::Lattice<Value>;

public:
    constexpr void reset() noexcept { last_.reset(Lattice::bottom()); }
    Value push(Value value) noexcept {
        last_.push(value);
        Value nth[n + 1];
        for (uint32_t k = 0; k <= n; ++k) nth[k] = k == 0 ? Lattice::top() : Lattice::bottom();
        for (uint32_t i = 0; i < Length; ++i)
            for (uint32_t k = n; k > 0; --k) nth[k] = max_of(nth[k], min_of(nth[k - 1], last_[i]));
        return nth[n];
    }

private:
    Last<Value, Length> last_;
};

template <class Value, uint32_t n, uint32_t Length, bool of_all>
struct AtLeast {
    using Type = AtLeastOfAll<Value, n, Length>;
};
template <class Value, uint32_t n, uint32_t Length>
struct AtLeast<Value, n, Length, false> {
    using Type = AtLeastOfFew<typename Nth<n>::template Of<Value>, n, Length>;
};

}  // namespace etlprove

namespace etlmon {
inline namespace ETLMON_BUILD {

template <class Value, uint32_t n, uint32_t Length>
class AtLeast
    : public etlprove::AtLeast<Value, n, Length,
                               detail::Same<Value, Truth>::value || keeps_order(n, Length)>::Type {
};

template <class Value, uint32_t n, uint32_t Length>
class AllBut {
public:
    constexpr void reset() noexcept { failed_.reset(); }
    Value push(Value value) noexcept { return negate(failed_.push(negate(value))); }

private:
    AtLeast<Value, n, Length> failed_;
};

}  // namespace ETLMON_BUILD
}  // namespace etlmon
