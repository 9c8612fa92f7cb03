// The cells and contestants of the distance bench.
// A contestant gives, per cell, a function that takes an embedding (D floats) and K x D row-major
// targets and returns the smallest l2 distance; setup, which is not timed, prepares the targets for
// it.
#pragma once

#include <cstdint>
#include <vector>

// D, K
#define ETLC_BENCH_CELLS(CELL) \
    CELL(2, 64)                \
    CELL(32, 4)                \
    CELL(32, 64)               \
    CELL(384, 1)               \
    CELL(384, 4)               \
    CELL(384, 16)              \
    CELL(384, 64)              \
    CELL(768, 16)              \
    CELL(3840, 4)              \
    CELL(3840, 64)             \
    CELL(384, 10000)

namespace bench {

struct Cell {
    std::uint32_t dimension, rows;
};

/// Returns the smallest distance from z. `state` is the result of setup.
using Nearest = float (*)(const float* z, const float* targets, const void* state);
using Setup = const void* (*)(const float* targets, std::uint32_t rows, std::uint32_t dimension);

/// The query points, used in turn.
struct Points {
    static constexpr std::size_t kNumber = 8;
    const float* first;
    std::size_t stride;  ///< floats from one to the next

    const float* operator[](std::size_t i) const { return first + i % kNumber * stride; }
};

struct Entry {
    Cell cell;
    Nearest nearest;
    void (*repeat)(Points points, const float* targets, const void* state, std::uint64_t calls);
};

/// Calls in sequence, as in a program compiled like the contestant: code that the compiler can
/// inline is part of the loop.
template <Nearest kNearest>
void repeat(Points points, const float* targets, const void* state, std::uint64_t calls) {
    volatile float sink = 0;
    for (std::uint64_t i = 0; i < calls; ++i) sink = kNearest(points[i], targets, state);
    static_cast<void>(sink);
}

template <Nearest kNearest>
Entry entry(Cell cell) {
    return {cell, kNearest, repeat<kNearest>};
}

struct Contestant {
    const char* name;
    Setup setup;  ///< may be nullptr
    std::vector<Entry> entries;
};

/// Returns |g|^2 of every row, for the form |z|^2 + |g|^2 - 2 z.g.
inline const void* squared_lengths(const float* targets, std::uint32_t rows,
                                   std::uint32_t dimension) {
    static std::vector<float> lengths;
    lengths.assign(rows, 0);
    for (std::uint32_t k = 0; k < rows; ++k) {
        for (std::uint32_t i = 0; i < dimension; ++i) {
            const float x = targets[std::size_t{k} * dimension + i];
            lengths[k] += x * x;
        }
    }
    return lengths.data();
}

Contestant etlmon_gxx();
Contestant etlmon_gxx_native();
Contestant etlmon_clang();
Contestant etlmon_clang_native();
Contestant eigen_gemv();
Contestant eigen_direct();
Contestant openblas();
Contestant highway();
Contestant naive_O2();
Contestant naive_O3_native();
Contestant read_floor();

}  // namespace bench
