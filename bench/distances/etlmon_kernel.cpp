// The runtime's kernel, as generated code calls it. Compiled once per compiler and set of flags;
// ETLC_BENCH_NAME is the function, and -Detlmon=... gives each its own namespace, so the linker
// keeps them apart.
#include "cells.hpp"
#include "etlmon/distance/kernel.hpp"

#define ETLC_TEXT_(x) #x
#define ETLC_TEXT(x) ETLC_TEXT_(x)

namespace ETLC_BENCH_NAME {
namespace {

template <std::uint32_t K, std::uint32_t D>
struct Kernel {
    static const void* columns(const float* targets) {
        static etlmon::detail::Columns<K, D> made;
        etlmon::detail::put_in_columns(targets, made);
        return made.values;
    }
    __attribute__((always_inline)) static inline float nearest(const float* z, const float* targets,
                                                               const void* state) {
        using namespace etlmon;
        if constexpr (detail::in_columns(K, D)) {
            const auto* columns = static_cast<const float*>(state);
            return detail::best<L2, Min, detail::Fixed<K, D>, true>(z, columns, nullptr, {}, {})
                .delta;
        } else {
            return detail::best<L2, Min, detail::Fixed<K, D>, false>(z, targets, nullptr, {}, {})
                .delta;
        }
    }
};

const void* setup(const float* targets, std::uint32_t rows, std::uint32_t dimension) {
#define CELL(D, K)                                                              \
    if constexpr (etlmon::detail::in_columns(K, D)) {                           \
        if (rows == K && dimension == D) return Kernel<K, D>::columns(targets); \
    }
    ETLC_BENCH_CELLS(CELL)
#undef CELL
    return nullptr;
}

}  // namespace
}  // namespace ETLC_BENCH_NAME

bench::Contestant bench::ETLC_BENCH_NAME() {
    using namespace ::ETLC_BENCH_NAME;
    return {ETLC_BENCH_TITLE,
            setup,
            {
#define CELL(D, K) entry<Kernel<K, D>::nearest>({D, K}),
                ETLC_BENCH_CELLS(CELL)
#undef CELL
            }};
}
