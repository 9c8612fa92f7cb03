// Every version of the kernel that this machine can run, against exact.hpp: within the stated bounds at every size, and
// the versions that fuse multiplication and addition against each other: equal bits.
#include <gtest/gtest.h>

#include "kernel_versions.hpp"

namespace {

using namespace kernel_cases;
using etlmon::Measured;
using etlmon::MetricId;
using etlmon::detail::Fixed;
using etlmon::detail::Sizes;

/// All versions on one case. `targets`: prepared, in the form that they take.
template <class Metric, class Aggregation, bool InColumns, class Size>
void expect_versions(const exact::Case& c, const exact::Judge& judge, exact::Aggregate aggregate, const char* kind,
                     const float* targets, Size size, Aggregation aggregation) {
    Measured fused{};
    bool has_fused = false;
    for (const auto& version : versions<Metric, Aggregation, Size, InColumns>()) {
        const Measured m = version.run(c.z.data(), targets, c.weights.data(), size, aggregation);
        ASSERT_EQ(judge.mismatch(aggregate, bits(m.delta), m.nearest), "")
            << version.name << ": " << describe(c, aggregate, kind);
#if !defined(__FAST_MATH__)
        if (version.fused && has_fused) {
            ASSERT_EQ(bits(m.delta), bits(fused.delta)) << version.name << ": " << describe(c, aggregate, kind);
            ASSERT_EQ(m.nearest, fused.nearest) << version.name << ": " << describe(c, aggregate, kind);
        }
#endif
        if (version.fused) fused = m, has_fused = true;
    }
}

template <class Metric>
void expect_rows(MetricId metric) {
    for (const std::uint32_t dimension : kDimensions) {
        for (const std::uint32_t rows : kRows) {
            if (metric == MetricId::mahalanobis && dimension * rows > 1000) continue;
            for (const Kind kind : {Kind::ordinary, Kind::near_target, Kind::equal, Kind::mixed, Kind::huge}) {
                if (rows == 64 && kind != Kind::ordinary && kind != Kind::equal) continue;
                const exact::Case c = make(metric, rows, dimension, kind, 21);
                const exact::Judge judge(c, kDenormals);
                std::vector<float> prepared = c.targets;
                etlmon::prepare(metric, prepared.data(), rows, dimension);
                const Sizes size{rows, dimension};
                const auto check = [&](exact::Aggregate aggregate, auto aggregation) {
                    expect_versions<Metric, decltype(aggregation), false>(c, judge, aggregate, name(kind),
                                                                          prepared.data(), size, aggregation);
                };
                std::vector<float> scratch(rows);
                const std::uint32_t n = (rows + 1) / 2;
                using Id = etlmon::AggregationId;
                check({Id::min, 1}, etlmon::Min{});
                check({Id::max, 1}, etlmon::Max{});
                check({Id::mean, 1}, etlmon::Mean{});
                check({Id::kth, n}, etlmon::KthOf{scratch.data(), n, 0});
                if (testing::Test::HasFatalFailure()) return;
            }
        }
    }
}

TEST(KernelVersions, EveryDistanceAggregationAndSize) {
#define DISTANCE(id, Type, low, high, prepared, zero_is_unknown) expect_rows<etlmon::Type>(MetricId::id);
#include "etlmon/distances.def"
#undef DISTANCE
}

template <class Metric, class Aggregation, std::uint32_t K, std::uint32_t D>
void expect_columns(MetricId metric, exact::Aggregate aggregate) {
    using namespace etlmon::detail;
    static_assert(in_columns(K, D) || !kHasPacks);
    static float rows[K * D];
    for (const Kind kind : kKinds) {
        const exact::Case c = make(metric, K, D, kind, 22);
        const exact::Judge judge(c, kDenormals);
        std::copy(c.targets.begin(), c.targets.end(), rows);
        etlmon::prepare(metric, rows, K, D);
        const Columns<K, D> columns = columns_of<K, D>(rows);
        if constexpr (kHasPacks) {
            expect_versions<Metric, Aggregation, true>(c, judge, aggregate, name(kind), columns.values, Fixed<K, D>{},
                                                       Aggregation{});
            // The same rows, not in columns: the same bits.
            const Measured in_rows =
                best<Metric, Aggregation, Fixed<K, D>, false>(c.z.data(), rows, c.weights.data(), {}, {});
            const Measured in_columns =
                best<Metric, Aggregation, Fixed<K, D>, true>(c.z.data(), columns.values, c.weights.data(), {}, {});
#if !defined(__FAST_MATH__)
            ASSERT_EQ(bits(in_columns.delta), bits(in_rows.delta)) << describe(c, aggregate, name(kind));
            ASSERT_EQ(in_columns.nearest, in_rows.nearest) << describe(c, aggregate, name(kind));
#endif
        }
    }
}

TEST(KernelVersions, Columns) {
    using Id = etlmon::AggregationId;
    expect_columns<etlmon::L2, etlmon::Min, 64, 2>(MetricId::l2, {});
    expect_columns<etlmon::L2, etlmon::Mean, 5, 7>(MetricId::l2, {Id::mean, 1});
    expect_columns<etlmon::L2Sq, etlmon::Min, 17, 1>(MetricId::l2sq, {});
    expect_columns<etlmon::L1, etlmon::Min, 100, 33>(MetricId::l1, {});
    expect_columns<etlmon::Linf, etlmon::Max, 64, 33>(MetricId::linf, {Id::max, 1});
    expect_columns<etlmon::Cosine, etlmon::Min, 64, 32>(MetricId::cosine, {});
    expect_columns<etlmon::Angular, etlmon::Kth<3>, 8, 3>(MetricId::angular, {Id::kth, 3});
    expect_columns<etlmon::MahalanobisDiagonal, etlmon::Min, 8, 3>(MetricId::mahalanobis_diagonal, {});
}

TEST(KernelVersions, LargeSetsAreReadInOneStream) {
    constexpr std::uint32_t kRowsOfStream = 530, kDimension = 1000;
    static_assert(etlmon::detail::order(kRowsOfStream, kDimension) == etlmon::detail::Order::four_chunks ||
                  !etlmon::detail::kHasPacks);
    const exact::Case c = make(MetricId::l2, kRowsOfStream, kDimension, Kind::near_target, 23);
    const exact::Judge judge(c, kDenormals);
    expect_versions<etlmon::L2, etlmon::Min, false>(c, judge, {}, "large", c.targets.data(),
                                                    Sizes{kRowsOfStream, kDimension}, etlmon::Min{});
}

}  // namespace
