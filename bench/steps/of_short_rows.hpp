// An example only for retargetable classes: many short rows.
#pragma once

#include "examples.hpp"
#include "short_rows.hpp"

namespace bench {
inline namespace BENCH_CLASSES {

struct ShortRows {
    static constexpr const char* kName = "short_rows: min l2, 6 x 32";
    using Monitor = short_rows::Monitor;
    float z[6];
    explicit ShortRows(Random& random) { fill(z, random, 0, 0.5F); }
    short_rows::Inputs inputs() const { return {z}; }
};

}  // namespace BENCH_CLASSES
}  // namespace bench
