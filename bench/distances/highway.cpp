// Highway: the direct form row by row, four sums, with the widest vectors of the compiler's target.
#define HWY_COMPILE_ONLY_STATIC  // what the compiler's target has, also where the dispatch of this
                                 // version does not know it
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "cells.hpp"

namespace bench {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

template <std::uint32_t K, std::uint32_t D>
__attribute__((noinline)) float direct(const float* z, const float* targets, const void*) {
    const hn::ScalableTag<float> d;
    const std::size_t lanes = hn::Lanes(d);
    float least = std::numeric_limits<float>::infinity();
    for (std::uint32_t k = 0; k < K; ++k) {
        const float* g = targets + std::size_t{k} * D;
        auto a = hn::Zero(d), b = hn::Zero(d), c = hn::Zero(d), e = hn::Zero(d);
        const auto add = [&](auto& to, std::size_t i) HWY_ATTR {
            const auto difference = hn::Sub(hn::LoadU(d, z + i), hn::LoadU(d, g + i));
            to = hn::MulAdd(difference, difference, to);
        };
        std::size_t i = 0;
        for (; i + 4 * lanes <= D; i += 4 * lanes)
            add(a, i), add(b, i + lanes), add(c, i + 2 * lanes), add(e, i + 3 * lanes);
        for (; i + lanes <= D; i += lanes) add(a, i);
        float sum = hn::GetLane(hn::SumOfLanes(d, hn::Add(hn::Add(a, b), hn::Add(c, e))));
        for (; i < D; ++i) sum += (z[i] - g[i]) * (z[i] - g[i]);
        least = std::min(least, sum);
    }
    return std::sqrt(least);
}

}  // namespace

Contestant highway() {
#define CELL(D, K) entry<direct<K, D>>({D, K}),
    return {"Highway", nullptr, {ETLC_BENCH_CELLS(CELL)}};
#undef CELL
}

}  // namespace bench
