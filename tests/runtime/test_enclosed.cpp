// Tests intervals from narrow copies of targets: the interval contains the distance in real
// arithmetic and the results of every version of the kernel on the float32 rows, and a comparison
// that it leaves open is doubtful.
#include "etlmon/distance/enclosed.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "enclosed_cases.hpp"
#include "kernel_versions.hpp"

namespace {

using namespace kernel_cases;
using etlmon::Enclosed;
using etlmon::Measured;
using etlmon::MetricId;

/// Prepared rows, their narrow copies widened, and how far these moved. The kernels give narrow
/// rows the bits of widened ones (test_narrow_halves.cpp, test_narrow_bytes.cpp), so the widened
/// ones are measured here.
struct Copies {
    std::vector<float> rows, halves, bytes;
    float moved_halves = 0, moved_bytes = 0;
};

/// Returns a float16 near x: truncated, so less exact than a rounded one; 0 for subnormal ones.
float truncated_half(float x) {
    const std::uint32_t b = bits(x);
    const int exponent = static_cast<int>((b >> 23) & 0xff) - 112;
    const std::uint32_t half =
        exponent <= 0 ? 0 : static_cast<std::uint32_t>(exponent) << 10 | (b >> 13 & 0x3ff);
    const auto narrow = static_cast<std::uint16_t>((b >> 16 & 0x8000) | half);
    return etlmon::detail::element(&narrow, 0);
}

Copies copies_of(const exact::Case& c) {
    Copies copies;
    copies.rows = c.targets;
    etlmon::prepare(c.metric, copies.rows.data(), c.rows, c.dimension);
    float greatest = 0;
    for (const float x : copies.rows) greatest = std::max(greatest, std::abs(x));
    const float scale = greatest / 127;
    for (const float x : copies.rows) {
        copies.halves.push_back(truncated_half(x));
        copies.bytes.push_back(scale * static_cast<float>(std::lrint(x / scale)));
    }
    copies.moved_halves = greatest_move(c, copies.halves);
    copies.moved_bytes = greatest_move(c, copies.bytes);
    return copies;
}

template <class Metric>
void expect_enclosed(const exact::Case& c, const std::vector<float>& rows,
                     const std::vector<float>& narrow_rows, float moved, exact::Aggregate aggregate,
                     const std::string& what) {
    const std::uint32_t averaged = aggregate.id == etlmon::AggregationId::mean ? c.rows : 0;
    const double exact = aggregated(c, aggregate);
    const auto all = row_versions<const float*>(c.metric);
    for (const auto& narrow : all) {
        const Measured m = narrow.measure(c, narrow_rows.data(), aggregate);
        const Enclosed e = etlmon::enclose<Metric>(m, moved, c.dimension, averaged);
        const bool bounded = etlmon::is_finite(e.high);
        if (bounded) {
            ASSERT_LE(double{e.low}, exact * (1 + 1e-12) + 1e-15) << narrow.name << ": " << what;
            ASSERT_GE(double{e.high}, exact * (1 - 1e-12) - 1e-15) << narrow.name << ": " << what;
        }
        for (const auto& wide : all) {
            const Measured of_rows = wide.measure(c, rows.data(), aggregate);
            const etlmon::Cut at[] = {of_rows.delta};
            ASSERT_TRUE(e.doubtful(at)) << narrow.name << ", " << wide.name << ": " << what;
            if (!bounded) continue;
            ASSERT_LE(e.low, of_rows.delta) << narrow.name << ", " << wide.name << ": " << what;
            ASSERT_GE(e.high, of_rows.delta) << narrow.name << ", " << wide.name << ": " << what;
        }
    }
}

template <class Metric>
void expect_case(const exact::Case& c, const Copies& copies, const char* kind) {
    using Id = etlmon::AggregationId;
    for (const exact::Aggregate aggregate :
         {exact::Aggregate{Id::min, 1}, {Id::mean, 1}, {Id::max, 1}, {Id::kth, (c.rows + 1) / 2}}) {
        const std::string what = describe(c, aggregate, kind);
        expect_enclosed<Metric>(c, copies.rows, copies.halves, copies.moved_halves, aggregate,
                                "f16, " + what);
        expect_enclosed<Metric>(c, copies.rows, copies.bytes, copies.moved_bytes, aggregate,
                                "i8, " + what);
    }
}

/// z on the line through a row and its narrow copy, where the distance changes by the whole move of
/// the row, near 0.
template <class Metric>
void expect_along_the_move(exact::Case c, const Copies& copies) {
    for (const auto* narrow : {&copies.halves, &copies.bytes}) {
        for (const float t : {-3.0F, -0.5F, 0.0F, 0.5F, 0.999F, 1.0F, 1.5F, 4.0F}) {
            for (std::size_t i = 0; i < c.dimension; ++i)
                c.z[i] = copies.rows[i] + t * ((*narrow)[i] - copies.rows[i]);
            if (std::all_of(c.z.begin(), c.z.end(), [](float x) { return x == 0; })) continue;
            expect_case<Metric>(c, copies, "along the move");
        }
    }
}

template <class Metric>
void expect_metric(MetricId metric) {
    for (const std::uint32_t dimension : kDimensions) {
        for (const std::uint32_t rows : {1U, 3U, 8U, 17U}) {
            for (const Kind kind : {Kind::ordinary, Kind::near_target, Kind::touching, Kind::equal,
                                    Kind::tiny, Kind::opposite}) {
                if (is_large(rows, dimension) && kind != Kind::ordinary && kind != Kind::equal)
                    continue;
                const exact::Case c = make(metric, rows, dimension, kind, 41);
                const Copies copies = copies_of(c);
                expect_case<Metric>(c, copies, name(kind));
                if (kind == Kind::ordinary && dimension * rows < 2000)
                    expect_along_the_move<Metric>(c, copies);
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
    EXPECT_TRUE(
        etlmon::enclose<etlmon::L2>({1.0F, 0}, 2e18F, 384).doubtful(far));  // its square overflows
    EXPECT_TRUE(etlmon::enclose<etlmon::Angular>({0.5F, 0}, 0.3F, 384)
                    .doubtful(far));  // the bound is for small moves
    EXPECT_FALSE(etlmon::enclose<etlmon::L2>({0.5F, 0}, 0.1F, 384).doubtful(far));
    EXPECT_TRUE(etlmon::enclose<etlmon::L2>({1.95F, 0}, 0.1F, 384).doubtful(far));
    EXPECT_TRUE(etlmon::enclose<etlmon::L2>({2.5F, 0}, 0.1F, 384).doubtful(far));  // inside a cut
}

}  // namespace
