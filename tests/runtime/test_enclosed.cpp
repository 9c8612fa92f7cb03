// What narrow copies of targets say about the targets: the interval holds the distance in real arithmetic and what
// every version of the kernel measures on the float32 rows, and a comparison that it leaves open is doubtful.
#include "etlmon/enclosed.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kernel_versions.hpp"

namespace {

using namespace kernel_cases;
using etlmon::Enclosed;
using etlmon::Measured;
using etlmon::MetricId;
using etlmon::detail::ScaledRows;
using etlmon::detail::Sizes;

/// The distance of two points by its definition, in double.
double distance_of(const exact::Case& c, const float* g) {
    double l1 = 0, linf = 0, square = 0, product = 0, z_square = 0, g_square = 0;
    for (std::size_t i = 0; i < c.dimension; ++i) {
        const double z = double{c.z[i]}, x = double{g[i]}, e = std::abs(z - x);
        const double w = c.metric == MetricId::mahalanobis_diagonal ? double{c.weights[i]} : 1.0;
        l1 += e, linf = std::max(linf, e), square += w * e * e;
        product += z * x, z_square += z * z, g_square += x * x;
    }
    const double cosine = std::clamp(product / std::sqrt(z_square) / std::sqrt(g_square), -1.0, 1.0);
    switch (c.metric) {
        case MetricId::l1: return l1;
        case MetricId::linf: return linf;
        case MetricId::l2sq: return square;
        case MetricId::cosine: return 1 - cosine;
        case MetricId::angular: return std::acos(cosine);
        default: return std::sqrt(square);
    }
}

double aggregated(const exact::Case& c, exact::Aggregate aggregate) {
    std::vector<double> rows;
    for (std::size_t k = 0; k < c.rows; ++k) rows.push_back(distance_of(c, c.targets.data() + k * c.dimension));
    if (aggregate.id == etlmon::AggregationId::mean)
        return std::accumulate(rows.begin(), rows.end(), 0.0) / static_cast<double>(rows.size());
    std::sort(rows.begin(), rows.end());
    if (aggregate.id == etlmon::AggregationId::max) return rows.back();
    return rows[aggregate.id == etlmon::AggregationId::kth ? aggregate.n - 1 : 0];
}

/// Prepared rows, their narrow copies, and how far these moved, in double.
struct Copies {
    std::vector<float> rows;
    std::vector<std::uint16_t> halves;
    std::vector<std::int8_t> bytes;
    float scale = 0;
    float moved_halves = 0, moved_bytes = 0;
};

/// Some float16 near x: truncated, so farther off than a rounded one.
std::uint16_t truncated_half(float x) {
    const std::uint32_t b = bits(x);
    const int exponent = static_cast<int>((b >> 23) & 0xff) - 112;
    if (exponent <= 0) return static_cast<std::uint16_t>(b >> 16 & 0x8000);  // subnormal ones count as zero here
    return static_cast<std::uint16_t>((b >> 16 & 0x8000) | static_cast<std::uint32_t>(exponent) << 10 |
                                      (b >> 13 & 0x3ff));
}

float greatest_move(const exact::Case& c, const Copies& copies, bool halves) {
    double greatest = 0;
    for (std::size_t k = 0; k < c.rows; ++k) {
        double length = 0;
        for (std::size_t i = 0; i < c.dimension; ++i) length += std::pow(double{c.targets[k * c.dimension + i]}, 2);
        const bool unit = etlmon::distance(c.metric).prepared == etlmon::Prepared::unit_rows;
        length = unit ? std::sqrt(length) : 1;
        double l1 = 0, linf = 0, square = 0;
        for (std::size_t i = 0; i < c.dimension; ++i) {
            const std::size_t at = k * c.dimension + i;
            const double there = halves ? double{etlmon::detail::element(&copies.halves[at], 0)}
                                        : double{copies.scale} * copies.bytes[at];
            const double e = std::abs(there - double{c.targets[at]} / length) + std::abs(there) * 0x1p-24;
            const double w = c.metric == MetricId::mahalanobis_diagonal ? double{c.weights[i]} : 1.0;
            l1 += e, linf = std::max(linf, e), square += w * e * e;
        }
        greatest = std::max(greatest, c.metric == MetricId::l1     ? l1
                                      : c.metric == MetricId::linf ? linf
                                                                   : std::sqrt(square));
    }
    return std::nextafter(static_cast<float>(greatest * (1 + 1e-6)), HUGE_VALF);
}

Copies copies_of(const exact::Case& c) {
    Copies copies;
    copies.rows = c.targets;
    etlmon::prepare(c.metric, copies.rows.data(), c.rows, c.dimension);
    float greatest = 0;
    for (const float x : copies.rows) greatest = std::max(greatest, std::abs(x));
    copies.scale = greatest / 127;
    for (const float x : copies.rows) {
        copies.halves.push_back(truncated_half(x));
        copies.bytes.push_back(static_cast<std::int8_t>(std::lrint(x / copies.scale)));
    }
    copies.moved_halves = greatest_move(c, copies, true);
    copies.moved_bytes = greatest_move(c, copies, false);
    return copies;
}

template <class Metric, class Aggregation, class G>
void expect_enclosed(const exact::Case& c, const Copies& copies, G rows, float moved, exact::Aggregate aggregate,
                     Aggregation aggregation, const std::string& what) {
    const Sizes size{c.rows, c.dimension};
    const std::uint32_t averaged = aggregate.id == etlmon::AggregationId::mean ? c.rows : 0;
    const double exact = aggregated(c, aggregate);
    for (const auto& narrow : versions<Metric, Aggregation, Sizes, false, G>()) {
        const Measured m = narrow.run(c.z.data(), rows, c.weights.data(), size, aggregation);
        const Enclosed e = etlmon::enclose<Metric>(m, moved, c.dimension, averaged);
        const bool bounded = etlmon::is_finite(e.high);
        if (bounded) {
            // cosine as 1 - cos and the arc cosine lose digits near 0 that the kernels keep.
            const double lost = c.metric == MetricId::cosine ? 1e-15 : c.metric == MetricId::angular ? 1e-7 : 0;
            ASSERT_LE(double{e.low}, exact + lost) << narrow.name << ": " << what;
            ASSERT_GE(double{e.high}, exact - lost) << narrow.name << ": " << what;
        }
        for (const auto& wide : versions<Metric, Aggregation, Sizes, false, const float*>()) {
            const Measured of_rows = wide.run(c.z.data(), copies.rows.data(), c.weights.data(), size, aggregation);
            const etlmon::Cut at[] = {of_rows.delta};
            ASSERT_TRUE(e.doubtful(at)) << narrow.name << ", " << wide.name << ": " << what;
            if (!bounded) continue;
            ASSERT_LE(e.low, of_rows.delta) << narrow.name << ", " << wide.name << ": " << what;
            ASSERT_GE(e.high, of_rows.delta) << narrow.name << ", " << wide.name << ": " << what;
        }
    }
}

template <class Metric>
void expect_case(const exact::Case& c, const char* kind) {
    using Id = etlmon::AggregationId;
    const Copies copies = copies_of(c);
    std::vector<float> scratch(c.rows);
    const std::uint32_t n = (c.rows + 1) / 2;
    const auto expect = [&](exact::Aggregate aggregate, auto aggregation) {
        const std::string what = describe(c, aggregate, kind);
        expect_enclosed<Metric>(c, copies, static_cast<const std::uint16_t*>(copies.halves.data()), copies.moved_halves,
                                aggregate, aggregation, "f16, " + what);
        expect_enclosed<Metric>(c, copies, ScaledRows{copies.bytes.data(), copies.scale}, copies.moved_bytes, aggregate,
                                aggregation, "i8, " + what);
    };
    expect({Id::min, 1}, etlmon::Min{});
    expect({Id::max, 1}, etlmon::Max{});
    expect({Id::mean, 1}, etlmon::Mean{});
    expect({Id::kth, n}, etlmon::KthOf{scratch.data(), n, 0});
}

template <class Metric>
void expect_metric(MetricId metric) {
    for (const std::uint32_t dimension : kDimensions) {
        for (const std::uint32_t rows : kRows) {
            for (const Kind kind :
                 {Kind::ordinary, Kind::near_target, Kind::touching, Kind::equal, Kind::tiny, Kind::opposite}) {
                if (dimension * rows > 4000 && kind != Kind::ordinary && kind != Kind::equal) continue;
                expect_case<Metric>(make(metric, rows, dimension, kind, 41), name(kind));
                if (testing::Test::HasFatalFailure()) return;
            }
        }
    }
}

TEST(Enclosed, L2) {
    expect_metric<etlmon::L2>(MetricId::l2);
}
TEST(Enclosed, L2Sq) {
    expect_metric<etlmon::L2Sq>(MetricId::l2sq);
}
TEST(Enclosed, L1) {
    expect_metric<etlmon::L1>(MetricId::l1);
}
TEST(Enclosed, Linf) {
    expect_metric<etlmon::Linf>(MetricId::linf);
}
TEST(Enclosed, Cosine) {
    expect_metric<etlmon::Cosine>(MetricId::cosine);
}
TEST(Enclosed, Angular) {
    expect_metric<etlmon::Angular>(MetricId::angular);
}
TEST(Enclosed, MahalanobisDiagonal) {
    expect_metric<etlmon::MahalanobisDiagonal>(MetricId::mahalanobis_diagonal);
}

TEST(Enclosed, WhatIsNotFiniteIsDoubtful) {
    const etlmon::Cut far[] = {1.0F, {2.0F, 3.0F}};
    for (const float delta : {HUGE_VALF, etlmon::kMissing, 3e38F})
        EXPECT_TRUE(etlmon::enclose<etlmon::L2Sq>({delta, 0}, 1e30F, 384).doubtful(far)) << delta;
    EXPECT_TRUE(etlmon::enclose<etlmon::Angular>({0.5F, 0}, 0.3F, 384).doubtful(far));  // the bound is for small moves
    EXPECT_FALSE(etlmon::enclose<etlmon::L2>({0.5F, 0}, 0.1F, 384).doubtful(far));
    EXPECT_TRUE(etlmon::enclose<etlmon::L2>({1.95F, 0}, 0.1F, 384).doubtful(far));
    EXPECT_TRUE(etlmon::enclose<etlmon::L2>({2.5F, 0}, 0.1F, 384).doubtful(far));  // inside a cut
}

}  // namespace
