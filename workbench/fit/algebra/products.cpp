#include "fit/algebra/products.hpp"

#include <algorithm>
#include <vector>

namespace etlc::fit {

namespace {

using Eigen::Index;

/// Rows that lie side by side once they are packed: those of a panel, for one column.
constexpr Index kPanel = 8;

struct alignas(64) PanelColumn {
    double rows[kPanel];
};

/// Panel by panel, in each column by column; rows that fill up the last one are 0.
std::vector<PanelColumn> packed(const Eigen::Ref<const Matrix>& columns) {
    const Index depth = columns.cols();
    const Index panels = (columns.rows() + kPanel - 1) / kPanel;
    std::vector<PanelColumn> result(static_cast<std::size_t>(panels * depth));
    for (Index panel = 0; panel < panels; ++panel) {
        const Index n = std::min(kPanel, columns.rows() - panel * kPanel);
        for (Index k = 0; k < depth; ++k)
            std::copy_n(columns.col(k).data() + panel * kPanel, n,
                        result[static_cast<std::size_t>(panel * depth + k)].rows);
    }
    return result;
}

// What is inlined into a function is compiled for the machine that the function is for.
#define ETLC_INLINE [[gnu::always_inline]] inline

/// A tile of the result, kPanel rows by `kColumns`, summed in registers of `Lanes`.
template <class Lanes, Index kColumns>
struct Tile {
    static constexpr Index kLanes = sizeof(Lanes) / sizeof(double);
    static constexpr Index kRegisters = kPanel / kLanes;

    Lanes sums[kColumns][kRegisters];

    ETLC_INLINE void sum(const PanelColumn* left, const PanelColumn* right, Index first,
                         Index depth) {
        for (Index j = 0; j < kColumns; ++j)
            for (Index r = 0; r < kRegisters; ++r) sums[j][r] = Lanes{};
        for (Index k = 0; k < depth; ++k) {
            Lanes rows[kRegisters];
            for (Index r = 0; r < kRegisters; ++r)
                rows[r] = *reinterpret_cast<const Lanes*>(left[k].rows + r * kLanes);
            for (Index j = 0; j < kColumns; ++j)
                for (Index r = 0; r < kRegisters; ++r)
                    sums[j][r] += rows[r] * right[k].rows[first + j];
        }
    }

    ETLC_INLINE void add_to(Eigen::Ref<Matrix>& lower, Index row, Index column,
                            double factor) const {
        const Index rows = std::min(kPanel, lower.rows() - row);
        for (Index j = 0; j < std::min(kColumns, lower.cols() - column); ++j) {
            double* to = &lower(row, column + j);
            for (Index i = 0; i < rows; ++i) to[i] += factor * sums[j][i / kLanes][i % kLanes];
        }
    }
};

template <class Lanes, Index kColumns>
ETLC_INLINE void add_tiles(const PanelColumn* panels, Index depth, double factor,
                           Eigen::Ref<Matrix>& lower) {
    const Index all = (lower.rows() + kPanel - 1) / kPanel;
    for (Index right = 0; right < all; ++right)
        for (Index left = right; left < all; ++left)
            for (Index first = 0; first < kPanel; first += kColumns) {
                Tile<Lanes, kColumns> tile;
                tile.sum(panels + left * depth, panels + right * depth, first, depth);
                tile.add_to(lower, left * kPanel, right * kPanel + first, factor);
            }
}

using Lanes16 [[gnu::vector_size(16), gnu::may_alias]] = double;

void add_with_16_bytes(const PanelColumn* panels, Index depth, double factor,
                       Eigen::Ref<Matrix>& lower) {
    add_tiles<Lanes16, 2>(panels, depth, factor, lower);
}

#if defined(__x86_64__)
using Lanes32 [[gnu::vector_size(32), gnu::may_alias]] = double;

[[gnu::target("avx2")]] void add_with_32_bytes(const PanelColumn* panels, Index depth,
                                               double factor, Eigen::Ref<Matrix>& lower) {
    add_tiles<Lanes32, 4>(panels, depth, factor, lower);
}

bool has_32_bytes() {
    return __builtin_cpu_supports("avx2") != 0;
}
#else
constexpr auto add_with_32_bytes = add_with_16_bytes;

constexpr bool has_32_bytes() {
    return false;
}
#endif

#undef ETLC_INLINE

}  // namespace

void add_products(const Eigen::Ref<const Matrix>& columns, double factor,
                  Eigen::Ref<Matrix> lower) {
    if (columns.cols() == 0) return;
    const std::vector<PanelColumn> panels = packed(columns);
    static const auto add = has_32_bytes() ? add_with_32_bytes : add_with_16_bytes;
    add(panels.data(), columns.cols(), factor, lower);
}

}  // namespace etlc::fit
