// Two plain loops. Compiled with several flags; ETLC_BENCH_NAME is the function.
#include <cmath>
#include <limits>

#include "cells.hpp"

namespace {

template <std::uint32_t K, std::uint32_t D>
__attribute__((noinline)) float direct(const float* z, const float* targets, const void*) {
    float least = std::numeric_limits<float>::infinity();
    for (std::uint32_t k = 0; k < K; ++k) {
        float sum = 0;
        for (std::uint32_t i = 0; i < D; ++i) {
            const float difference = z[i] - targets[std::size_t{k} * D + i];
            sum += difference * difference;
        }
        if (sum < least) least = sum;
    }
    return std::sqrt(least);
}

}  // namespace

bench::Contestant bench::ETLC_BENCH_NAME() {
#define CELL(D, K) entry<direct<K, D>>({D, K}),
    return {ETLC_BENCH_TITLE, nullptr, {ETLC_BENCH_CELLS(CELL)}};
#undef CELL
}
