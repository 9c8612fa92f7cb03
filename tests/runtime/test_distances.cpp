// Compares every distance and aggregation with exact.hpp, within the stated bounds, at every size
// and kind of input.
#include <gtest/gtest.h>

#include "kernel_cases.hpp"

namespace {

using namespace kernel_cases;
using etlmon::MetricId;

class Distances : public testing::TestWithParam<MetricId> {};

std::vector<Kind> kinds_of(MetricId metric, std::uint32_t rows, std::uint32_t dimension) {
    if (is_heavy(metric, rows, dimension)) return {Kind::ordinary, Kind::touching};
    if (is_large(rows, dimension)) return {Kind::ordinary, Kind::equal, Kind::huge};
    return kKinds;
}

TEST_P(Distances, WithinTheirBounds) {
    for (const std::uint32_t dimension : kDimensions) {
        for (const std::uint32_t rows : rows_of(GetParam(), dimension)) {
            const bool heavy = is_heavy(GetParam(), rows, dimension);
            for (const Kind kind : kinds_of(GetParam(), rows, dimension)) {
                const exact::Case c = make(GetParam(), rows, dimension, kind, 1);
                const exact::Judge judge(c, kFlushesDenormals);
                for (const exact::Aggregate a :
                     heavy ? std::vector<exact::Aggregate>{{}} : aggregates(rows)) {
                    const etlmon::Measured m = run(c, a);
                    ASSERT_EQ(judge.mismatch(a, bits(m.delta), m.nearest), "")
                        << describe(c, a, name(kind));
                }
            }
        }
    }
}

TEST_P(Distances, NearestIsTheLowestOfEqualRows) {
    exact::Case c = make(GetParam(), 1, 5, Kind::ordinary, 3);
    const std::vector<float> row = c.targets;
    c.rows = 9;
    for (std::uint32_t i = 1; i < c.rows; ++i) {
        std::vector<float> next = row;
        if (i < 4) next[2] += 1 + static_cast<float>(i);  // rows 0, 4, ... are equal
        c.targets.insert(c.targets.end(), next.begin(), next.end());
    }
    c.z = row;
    c.z[1] += 0.125F;
    for (const exact::Aggregate a : aggregates(c.rows))
        EXPECT_EQ(run(c, a).nearest, 0U) << describe(c, a, "ties");
    std::swap_ranges(c.targets.begin(), c.targets.begin() + 5, c.targets.begin() + 5);
    for (const exact::Aggregate a : aggregates(c.rows))
        EXPECT_EQ(run(c, a).nearest, 1U) << describe(c, a, "ties");
}

TEST_P(Distances, ZeroVectors) {
    exact::Case c = make(GetParam(), 4, 6, Kind::ordinary, 4);
    c.z.assign(6, 0.0F);
    c.z[3] = -0.0F;
    const exact::Judge judge(c, kFlushesDenormals);
    for (const exact::Aggregate a : aggregates(c.rows)) {
        const etlmon::Measured m = run(c, a);
        EXPECT_EQ(judge.mismatch(a, bits(m.delta), m.nearest), "") << describe(c, a, "zero");
        EXPECT_EQ(etlmon::is_nan(m.delta), etlmon::distance(c.metric).zero_is_unknown);
    }
}

INSTANTIATE_TEST_SUITE_P(All, Distances, testing::ValuesIn(metrics()), [](const auto& of) {
    return std::string(etlmon::distance(of.param).word);
});

TEST(Distances, EqualVectorsAreAtZero) {
    for (const MetricId metric : {MetricId::l2, MetricId::l2sq, MetricId::l1, MetricId::linf,
                                  MetricId::mahalanobis, MetricId::mahalanobis_diagonal}) {
        for (const std::uint32_t dimension : {1U, 7U, 33U}) {
            const exact::Case c = make(metric, 4, dimension, Kind::equal, 5);
            EXPECT_EQ(bits(run(c, {}).delta), 0U) << describe(c, {}, "equal");
        }
    }
}

TEST(Distances, SmallCosineKeepsItsDigits) {
    // z = (1, t) and g = (1, 0): 1 - cos = t^2 / 2 - ..., far below one rounding of 1.
    for (const float t : {1e-3F, 1e-4F, 1e-5F}) {
        exact::Case c{MetricId::cosine, 1, 2, {1, t}, {1, 0}, {}};
        const float want = t * t / 2;
        EXPECT_NEAR(run(c, {}).delta, want, 2e-2F * want) << t;
        c.metric = MetricId::angular;
        EXPECT_NEAR(run(c, {}).delta, t, 1e-6F * t + 2e-7F) << t;
    }
}

TEST(Distances, AngularKeepsItsDigitsNearPi) {
    for (const float t : {0.0F, 1e-3F, 1e-4F}) {
        const exact::Case c{MetricId::angular, 1, 2, {-1, t}, {1, 0}, {}};
        EXPECT_NEAR(run(c, {}).delta, 3.14159265F - t, 5e-7F) << t;
    }
}

TEST(Distances, OverflowOnlyWhereTheDistanceDoes) {
    const float most = FLT_MAX;
    const exact::Case fits{MetricId::l2, 1, 2, {1e38F, 2e38F}, {-1e38F, 0}, {}};
    EXPECT_NEAR(run(fits, {}).delta * 1e-30F, 2.82842712e8F, 100.0F);
    const exact::Case apart{MetricId::l2, 1, 2, {most, most}, {-most, -most}, {}};
    EXPECT_EQ(bits(run(apart, {}).delta), 0x7f800000U);
    const exact::Case weighted{
        MetricId::mahalanobis_diagonal, 1, 2, {most, 0}, {-most, 0}, {1e-30F, 1e-30F}};
    EXPECT_NEAR(run(weighted, {}).delta * 1e-23F, 6.80564693F, 1e-6F);
    const exact::Case full{MetricId::mahalanobis, 1, 2, {most, 0}, {-most, 0},
                           {1e-30F, 0, 0, 1e-30F}};
    EXPECT_NEAR(run(full, {}).delta * 1e-23F, 6.80564693F, 1e-6F);
}

TEST(Distances, MeanOfHugeDistancesDoesNotOverflow) {
    exact::Case c{MetricId::l2, 4, 1, {0}, {3e38F, 3e38F, 2e38F, 3e38F}, {}};
    const etlmon::Measured m = run(c, {etlmon::AggregationId::mean, 1});
    EXPECT_NEAR(m.delta * 1e-30F, 2.75e8F, 100.0F);
    EXPECT_EQ(m.nearest, 2U);
}

TEST(Distances, FarRowsDoNotHideTheNearest) {
    // Row 0 overflows as a square; row 1 underflows as one.
    const exact::Case c{MetricId::l2, 3, 2, {1e-25F, 0}, {1e30F, 0, 0, 0, 1, 1}, {}};
    const etlmon::Measured m = run(c, {});
    EXPECT_EQ(m.nearest, 1U);
    EXPECT_NEAR(m.delta * 1e25F, 1.0F, 1e-6F);
}

TEST(Distances, MahalanobisAgreesWithItsDiagonalForm) {
    exact::Case diagonal = make(MetricId::mahalanobis_diagonal, 5, 7, Kind::ordinary, 6);
    exact::Case full = diagonal;
    full.metric = MetricId::mahalanobis;
    full.weights.assign(49, 0.0F);
    for (std::size_t i = 0; i < 7; ++i) full.weights[i * 8] = diagonal.weights[i];
    for (const exact::Aggregate a : aggregates(5)) {
        EXPECT_NEAR(run(full, a).delta, run(diagonal, a).delta, 1e-5F)
            << describe(full, a, "diagonal");
    }
}

TEST(Distances, PreparationNamesTheFirstRowWithoutDirection) {
    std::vector<float> targets{3, 4, 0, 0, 0, 2};
    EXPECT_EQ(etlmon::prepare(MetricId::cosine, targets.data(), 3, 2), 1U);
    EXPECT_EQ(targets, (std::vector<float>{0.6F, 0.8F, 0, 0, 0, 1}));
    EXPECT_EQ(etlmon::prepare(MetricId::l2, targets.data(), 3, 2), 3U);
}

}  // namespace
