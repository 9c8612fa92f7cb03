// Compares every version of the kernel that this machine can run with exact.hpp, within the stated
// bounds at every size, and the versions that fuse multiplication and addition with each other:
// they give equal bits.
#include <gtest/gtest.h>

#include "kernel_versions.hpp"

namespace {

using namespace kernel_cases;
using etlmon::Measured;
using etlmon::MetricId;
using etlmon::detail::Fixed;

/// The result of one version for a case.
struct Answer {
    const char* version;
    bool fused;
    Measured measured;
};

void expect_answers(const std::vector<Answer>& answers, const exact::Case& c,
                    const exact::Judge& judge, exact::Aggregate aggregate, const char* kind) {
    const Answer* fused = nullptr;
    for (const Answer& answer : answers) {
        const Measured m = answer.measured;
        ASSERT_EQ(judge.mismatch(aggregate, bits(m.delta), m.nearest), "")
            << answer.version << ": " << describe(c, aggregate, kind);
#if !defined(__FAST_MATH__)
        if (answer.fused && fused != nullptr) {
            ASSERT_EQ(bits(m.delta), bits(fused->measured.delta))
                << answer.version << ": " << describe(c, aggregate, kind);
            ASSERT_EQ(m.nearest, fused->measured.nearest)
                << answer.version << ": " << describe(c, aggregate, kind);
        }
#endif
        if (answer.fused) fused = &answer;
    }
}

/// rows: prepared.
void expect_row_versions(const exact::Case& c, const exact::Judge& judge, const float* rows,
                         exact::Aggregate aggregate, const char* kind) {
    std::vector<Answer> answers;
    for (const auto& version : row_versions<const float*>(c.metric))
        answers.push_back({version.name, version.fused, version.measure(c, rows, aggregate)});
    expect_answers(answers, c, judge, aggregate, kind);
}

std::vector<Kind> kinds_of(MetricId metric, std::uint32_t rows, std::uint32_t dimension) {
    if (is_heavy(metric, rows, dimension)) return {Kind::ordinary};
    if (rows == 64 || is_large(rows, dimension)) return {Kind::ordinary, Kind::equal};
    return {Kind::ordinary, Kind::near_target, Kind::equal, Kind::mixed, Kind::huge};
}

class KernelVersions : public testing::TestWithParam<MetricId> {};

TEST_P(KernelVersions, EveryAggregationAndSize) {
    for (const std::uint32_t dimension : kDimensions) {
        for (const std::uint32_t rows : rows_of(GetParam(), dimension)) {
            for (const Kind kind : kinds_of(GetParam(), rows, dimension)) {
                const exact::Case c = make(GetParam(), rows, dimension, kind, 21);
                const exact::Judge judge(c, kFlushesDenormals);
                std::vector<float> prepared = c.targets;
                etlmon::prepare(c.metric, prepared.data(), rows, dimension);
                for (const exact::Aggregate aggregate :
                     aggregates(rows, is_heavy(GetParam(), rows, dimension)))
                    expect_row_versions(c, judge, prepared.data(), aggregate, name(kind));
                if (HasFatalFailure()) return;
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(All, KernelVersions, testing::ValuesIn(metrics()), [](const auto& of) {
    return std::string(etlmon::distance(of.param).word);
});

template <class Metric, class Aggregation, std::uint32_t K, std::uint32_t D>
void expect_columns(MetricId metric, exact::Aggregate aggregate) {
    using namespace etlmon::detail;
    static_assert(in_columns(K, D));
    static float rows[K * D];
    for (const Kind kind : kKinds) {
        const exact::Case c = make(metric, K, D, kind, 22);
        const exact::Judge judge(c, kFlushesDenormals);
        std::copy(c.targets.begin(), c.targets.end(), rows);
        etlmon::prepare(metric, rows, K, D);
        const Columns<K, D> columns = columns_of<K, D>(rows);
        std::vector<Answer> answers;
        for (const auto& version : versions<Metric, Aggregation, Fixed<K, D>, true>())
            answers.push_back(
                {version.name, version.fused,
                 unpacked(version.run(c.z.data(), columns.values, c.weights.data(), {}, {}))});
        expect_answers(answers, c, judge, aggregate, name(kind));
        // The same rows, not in columns, give the same bits.
        const Measured in_rows = best<Metric, Aggregation, Fixed<K, D>, false>(
            c.z.data(), rows, c.weights.data(), {}, {});
        const Measured in_columns = best<Metric, Aggregation, Fixed<K, D>, true>(
            c.z.data(), columns.values, c.weights.data(), {}, {});
#if !defined(__FAST_MATH__)
        ASSERT_EQ(bits(in_columns.delta), bits(in_rows.delta))
            << describe(c, aggregate, name(kind));
        ASSERT_EQ(in_columns.nearest, in_rows.nearest) << describe(c, aggregate, name(kind));
#endif
    }
}

TEST(ColumnVersions, WithinTheirBounds) {
    using Id = etlmon::AggregationId;
    expect_columns<etlmon::L2, etlmon::Min, 64, 2>(MetricId::l2, {});
    expect_columns<etlmon::L2, etlmon::Mean, 5, 7>(MetricId::l2, {Id::mean, 1});
    expect_columns<etlmon::L2Sq, etlmon::Min, 17, 1>(MetricId::l2sq, {});
    expect_columns<etlmon::L1, etlmon::Min, 100, 33>(MetricId::l1, {});
    expect_columns<etlmon::Linf, etlmon::Max, 64, 33>(MetricId::linf, {Id::max, 1});
    expect_columns<etlmon::Cosine, etlmon::Min, 64, 32>(MetricId::cosine, {});
    expect_columns<etlmon::Angular, etlmon::Kth<3>, 8, 3>(MetricId::angular, {Id::kth, 3});
    expect_columns<etlmon::MahalanobisDiagonal, etlmon::Min, 8, 3>(MetricId::mahalanobis_diagonal,
                                                                   {});
}

TEST(LargeSetVersions, AreReadInOneStream) {
    constexpr std::uint32_t kRowsOfStream = 530, kDimension = 1000;
    static_assert(etlmon::detail::order(kRowsOfStream, kDimension) ==
                      etlmon::detail::Order::four_chunks ||
                  !etlmon::detail::kHasVectors);
    const exact::Case c = make(MetricId::l2, kRowsOfStream, kDimension, Kind::near_target, 23);
    const exact::Judge judge(c, kFlushesDenormals);
    expect_row_versions(c, judge, c.targets.data(), {}, "large");
}

}  // namespace
