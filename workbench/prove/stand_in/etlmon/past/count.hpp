// SPDX-License-Identifier: MIT
// Stands in for a part of the runtime's count.hpp when `etlc prove` compiles a class: the merge of
// two sorted lists, which compares values, is replaced by mins and maxes with the same result. The
// windows that it is used in are the runtime's.
#pragma once

#include_next "etlmon/past/count.hpp"

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

template <class Value, uint32_t n, uint32_t Length>
class AtLeast {
    using Few = typename Nth<n>::template Of<Value>;

public:
    constexpr void reset() noexcept { window_.reset(); }
    Value push(Value value) noexcept { return window_.push(Few::at(value)).values[n - 1]; }

private:
    etlmon::Window<Few, Length> window_;
};

}  // namespace etlprove

namespace etlmon {
inline namespace ETLMON_BUILD {

template <uint32_t n, uint32_t Length>
class AtLeast<Value, n, Length> : public etlprove::AtLeast<Value, n, Length> {};
template <uint32_t n, uint32_t Length>
class AtLeast<Sourced, n, Length> : public etlprove::AtLeast<Sourced, n, Length> {};

}  // namespace ETLMON_BUILD
}  // namespace etlmon
