// OpenBLAS: sgemv, |z|^2 + |g|^2 - 2 z.g, on one thread.
#include <cblas.h>

#include <algorithm>
#include <cmath>

#include "cells.hpp"

namespace bench {
namespace {

const void* setup(const float* targets, std::uint32_t rows, std::uint32_t dimension) {
    openblas_set_num_threads(1);
    return squared_lengths(targets, rows, dimension);
}

template <std::uint32_t K, std::uint32_t D>
__attribute__((noinline)) float gemv(const float* z, const float* targets, const void* lengths) {
    static float sums[K];
    std::copy_n(static_cast<const float*>(lengths), K, sums);
    cblas_sgemv(CblasRowMajor, CblasNoTrans, K, D, -2.0F, targets, D, z, 1, 1.0F, sums, 1);
    const float square = cblas_sdot(D, z, 1, z, 1);
    return std::sqrt(std::max(0.0F, square + *std::min_element(sums, sums + K)));
}

}  // namespace

Contestant openblas() {
#define CELL(D, K) entry<gemv<K, D>>({D, K}),
    return {"OpenBLAS", setup, {ETLC_BENCH_CELLS(CELL)}};
#undef CELL
}

}  // namespace bench
