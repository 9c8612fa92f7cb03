// The classes of cases.hpp made with --explain.
#pragma once

#include "always_1000_why.hpp"
#include "always_eventually_50_why.hpp"
#include "always_until_100_why.hpp"
#include "cases.hpp"
#include "chain_24_why.hpp"
#include "chains.hpp"
#include "change_10_why.hpp"
#include "count_50_why.hpp"
#include "eventually_50_why.hpp"
#include "eventually_always_1000_why.hpp"
#include "invariant_why.hpp"
#include "machine_small_why.hpp"
#include "machine_why.hpp"
#include "mean_50_why.hpp"
#include "nested_bounds_why.hpp"
#include "nested_why.hpp"
#include "one_why.hpp"
#include "response_50_why.hpp"
#include "responses_why.hpp"
#include "sequence_why.hpp"
#include "three_why.hpp"
#include "two_why.hpp"
#include "until_10000_why.hpp"
#include "until_100_why.hpp"
#include "until_24_why.hpp"

namespace bench {

/// Nothing for a class that exceeds --max-state with it.
template <class Monitor>
struct Explained {
    static constexpr bool kExists = false;
};

#define BENCH_EXPLAINED(NAME)                 \
    template <>                               \
    struct Explained<NAME::Monitor> {         \
        static constexpr bool kExists = true; \
        using Monitor = NAME##_why::Monitor;  \
        using Inputs = NAME##_why::Inputs;    \
    };
BENCH_EXPLAINED(one)
BENCH_EXPLAINED(two)
BENCH_EXPLAINED(three)
BENCH_EXPLAINED(invariant)
BENCH_EXPLAINED(eventually_50)
BENCH_EXPLAINED(always_1000)
BENCH_EXPLAINED(until_100)
BENCH_EXPLAINED(response_50)
BENCH_EXPLAINED(sequence)
BENCH_EXPLAINED(count_50)
BENCH_EXPLAINED(mean_50)
BENCH_EXPLAINED(change_10)
BENCH_EXPLAINED(chain_24)
BENCH_EXPLAINED(until_24)
BENCH_EXPLAINED(responses)
BENCH_EXPLAINED(always_eventually_50)
BENCH_EXPLAINED(eventually_always_1000)
BENCH_EXPLAINED(always_until_100)
BENCH_EXPLAINED(nested)
BENCH_EXPLAINED(nested_bounds)
BENCH_EXPLAINED(until_10000)
BENCH_EXPLAINED(machine_small)
BENCH_EXPLAINED(machine)
#undef BENCH_EXPLAINED

}  // namespace bench
