// Compares the kernel with compile-time sizes and the same kernel with run-time sizes: they give
// equal bits. Under -ffast-math the compiler may add in another order in each; then both must be
// within the bounds.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "kernel_cases.hpp"

namespace {

using namespace kernel_cases;
using etlmon::Measured;
using etlmon::MetricId;

template <class Metric, class Aggregation, std::uint32_t K, std::uint32_t D>
Measured fixed(const exact::Case& c) {
    static float targets[K * D];
    std::copy(c.targets.begin(), c.targets.end(), targets);
    etlmon::prepare(c.metric, targets, K, D);
    if constexpr (Metric::kQuadratic || Metric::kWeighted) {
        static float weights[Metric::kQuadratic ? D * D : D];
        std::copy(c.weights.begin(), c.weights.end(), weights);
        return etlmon::measure<Metric, Aggregation, K, D>(c.z.data(), targets, weights);
    } else {
        return etlmon::measure<Metric, Aggregation, K, D>(c.z.data(), targets);
    }
}

template <class Metric, class Aggregation, std::uint32_t K, std::uint32_t D>
void expect_twins(MetricId metric, exact::Aggregate aggregate) {
    for (const Kind kind : kKinds) {
        const exact::Case c = make(metric, K, D, kind, 11);
        const Measured one = fixed<Metric, Aggregation, K, D>(c);
        const Measured two = run(c, aggregate);
#if defined(__FAST_MATH__)
        const exact::Judge judge(c, kFlushesDenormals);
        EXPECT_EQ(judge.mismatch(aggregate, bits(one.delta), one.nearest), "")
            << describe(c, aggregate, name(kind));
        EXPECT_EQ(judge.mismatch(aggregate, bits(two.delta), two.nearest), "")
            << describe(c, aggregate, name(kind));
#else
        EXPECT_EQ(bits(one.delta), bits(two.delta)) << describe(c, aggregate, name(kind));
        EXPECT_EQ(one.nearest, two.nearest) << describe(c, aggregate, name(kind));
#endif
    }
}

template <class Metric, std::uint32_t K, std::uint32_t D>
void expect_twins(MetricId metric) {
    using Id = etlmon::AggregationId;
    expect_twins<Metric, etlmon::Min, K, D>(metric, {Id::min, 1});
    expect_twins<Metric, etlmon::Max, K, D>(metric, {Id::max, 1});
    expect_twins<Metric, etlmon::Mean, K, D>(metric, {Id::mean, 1});
    expect_twins<Metric, etlmon::Kth<(K + 1) / 2>, K, D>(metric, {Id::kth, (K + 1) / 2});
}

TEST(KernelTwins, EveryDistanceAndAggregation) {
#define DISTANCE(id, Type, prepared, zero_is_unknown) \
    expect_twins<etlmon::Type, 3, 7>(etlmon::MetricId::id);
#include "etlmon/distance/distances.def"
#undef DISTANCE
}

// Measuring rows does not depend on the aggregation.
TEST(KernelTwins, EveryDistanceInVectors) {
#define DISTANCE(id, Type, prepared, zero_is_unknown) \
    expect_twins<etlmon::Type, etlmon::Min, 4, 33>(etlmon::MetricId::id, {});
#include "etlmon/distance/distances.def"
#undef DISTANCE
    using Id = etlmon::AggregationId;
    expect_twins<etlmon::L1, etlmon::Max, 4, 33>(MetricId::l1, {Id::max, 1});
    expect_twins<etlmon::Cosine, etlmon::Mean, 4, 33>(MetricId::cosine, {Id::mean, 1});
    expect_twins<etlmon::L2, etlmon::Kth<2>, 4, 33>(MetricId::l2, {Id::kth, 2});
}

template <std::uint32_t K, std::uint32_t D>
void expect_nearest_twins() {
    expect_twins<etlmon::L2, etlmon::Min, K, D>(MetricId::l2, {});
}

TEST(KernelTwins, EveryOrderOfAdditions) {
    expect_nearest_twins<1, 1>();
    expect_nearest_twins<64, 2>();
    expect_nearest_twins<5, 7>();
    expect_nearest_twins<2, 32>();
    expect_nearest_twins<64, 33>();
    expect_nearest_twins<1, 384>();
    expect_nearest_twins<17, 384>();
    expect_nearest_twins<8, 1000>();
    // In blocks of 64, 32 or 16 elements: some sizes without whole blocks, some with vectors after
    // them, some with a remainder.
    expect_nearest_twins<1, 16>();
    expect_nearest_twins<1, 17>();
    expect_nearest_twins<1, 32>();
    expect_nearest_twins<1, 63>();
    expect_nearest_twins<1, 64>();
    expect_nearest_twins<1, 120>();
    expect_nearest_twins<2, 16>();
    expect_nearest_twins<2, 48>();
    expect_nearest_twins<2, 65>();
    expect_nearest_twins<5, 16>();
    expect_nearest_twins<5, 20>();
    expect_nearest_twins<300, 80>();
    expect_twins<etlmon::Linf, etlmon::Min, 1, 48>(MetricId::linf, {});
    expect_twins<etlmon::Angular, etlmon::Min, 1, 48>(MetricId::angular, {});
    expect_twins<etlmon::Cosine, etlmon::Min, 2, 7>(MetricId::cosine, {});
    expect_twins<etlmon::Cosine, etlmon::Min, 17, 33>(MetricId::cosine, {});
}

/// Returns a number in [-1, 1) for each i.
constexpr float number(std::size_t i) {
    return static_cast<float>((static_cast<std::uint32_t>(i) * 2654435761u + 12345u) >> 8) /
               8388608.0f -
           1.0f;
}

std::vector<float> numbers(std::size_t count, std::size_t from) {
    std::vector<float> result;
    for (std::size_t i = 0; i < count; ++i) result.push_back(number(from + i));
    return result;
}

template <std::uint32_t R, std::uint32_t D>
void expect_projected_twins() {
    const std::vector<float> z = numbers(D, 0), matrix = numbers(R * D, 1000),
                             offset = numbers(D, 7);
    float one[R], two[R], centred[D];
    for (const float* const m : {offset.data(), static_cast<const float*>(nullptr)}) {
        const float* const y = m == nullptr
                                   ? etlmon::project<R, D>(z.data(), matrix.data(), one)
                                   : etlmon::project<R, D>(z.data(), matrix.data(), m, one);
        ASSERT_EQ(y, &one[0]);
        ASSERT_TRUE(etlmon::project(z.data(), matrix.data(), m, R, D, centred, two));
        for (std::uint32_t i = 0; i < R; ++i) {
            EXPECT_EQ(bits(one[i]), bits(two[i])) << R << " x " << D << ", row " << i;
            double exact = 0, magnitude = 0, size = 0;
            for (std::uint32_t j = 0; j < D; ++j) {
                const double difference =
                    static_cast<double>(z[j]) - (m == nullptr ? 0.0 : static_cast<double>(m[j]));
                const double a = static_cast<double>(matrix[i * D + j]);
                exact += a * difference;
                magnitude += std::abs(a * difference);
                size += std::abs(a) + std::abs(difference);
            }
            EXPECT_LE(std::abs(static_cast<double>(one[i]) - exact),
                      etlmon::projection_bound(D, magnitude, size))
                << R << " x " << D << ", row " << i;
        }
    }
}

TEST(KernelTwins, Projections) {
    expect_projected_twins<1, 1>();
    expect_projected_twins<5, 7>();
    expect_projected_twins<1, 384>();
    expect_projected_twins<3, 16>();
    expect_projected_twins<16, 384>();
    expect_projected_twins<33, 65>();
    expect_projected_twins<64, 3>();
}

TEST(KernelTwins, ProjectionsThatAreUnknown) {
    const std::vector<float> matrix{0, 0, 3e38f, 3e38f};
    float z[2] = {1, 0.5f}, y[2];
    const etlmon::Vector<float, 2> sample(z), missing;
    EXPECT_EQ((etlmon::project<2, 2>(sample, matrix.data(), y)), nullptr);  // 4.5e38
    z[0] = 0.25f;
    EXPECT_EQ((etlmon::project<2, 2>(sample, matrix.data(), y)), &y[0]);
    EXPECT_EQ((etlmon::project<2, 2>(missing, matrix.data(), y)), nullptr);
    const etlmon::Point<2> partly{{0, etlmon::kMissing}};  // a missing sample with bits of 0
    EXPECT_EQ((etlmon::project<2, 2>(partly, matrix.data(), y)), nullptr);
}

#if !defined(__FAST_MATH__)

template <class Indices>
struct Numbers;
template <std::size_t... I>
struct Numbers<std::index_sequence<I...>> {
    static constexpr float kValues[] = {number(I)...};
};

template <class Metric, class Aggregation, std::uint32_t K, std::uint32_t D>
void expect_told_twins(MetricId metric) {
    constexpr const auto& rows = Numbers<std::make_index_sequence<K * D>>::kValues;
    const auto expect_equal = [](etlmon::Vector<float, D> z, const std::string& which) {
        const Measured one = etlmon::measure<Metric, Aggregation, K, D, rows>(z);
        const Measured two =
            etlmon::measure<Metric, Aggregation, K, D, rows>(etlmon::direction_of(z));
        EXPECT_EQ(bits(one.delta), bits(two.delta)) << which << ", " << K << " x " << D;
        EXPECT_EQ(one.nearest, two.nearest) << which << ", " << K << " x " << D;
    };
    expect_equal({}, "missing");
    for (const Kind kind : kKinds) {
        const exact::Case c = make(metric, K, D, kind, 13);
        expect_equal(etlmon::Vector<float, D>::unchecked(c.z.data()), name(kind));
        for (const float factor : {0.0f, 1e-30f, 1e30f, HUGE_VALF, etlmon::kMissing}) {
            std::vector<float> z = c.z;
            for (float& x : z) x *= factor;
            expect_equal(etlmon::Vector<float, D>::unchecked(z.data()),
                         name(kind) + (" times " + std::to_string(factor)));
        }
    }
}

TEST(KernelTwins, ADirectionFoundOnceForSeveralDistances) {
    expect_told_twins<etlmon::Cosine, etlmon::Min, 1, 1>(MetricId::cosine);
    expect_told_twins<etlmon::Cosine, etlmon::Kth<2>, 3, 7>(MetricId::cosine);
    expect_told_twins<etlmon::Cosine, etlmon::Mean, 8, 3>(MetricId::cosine);
    expect_told_twins<etlmon::Cosine, etlmon::Min, 8, 32>(MetricId::cosine);
    expect_told_twins<etlmon::Cosine, etlmon::Max, 64, 33>(MetricId::cosine);
    expect_told_twins<etlmon::Cosine, etlmon::Min, 4, 384>(MetricId::cosine);
    expect_told_twins<etlmon::Angular, etlmon::Min, 1, 384>(MetricId::angular);
    expect_told_twins<etlmon::Angular, etlmon::Max, 5, 7>(MetricId::angular);
    expect_told_twins<etlmon::Angular, etlmon::Mean, 17, 40>(MetricId::angular);
}

TEST(KernelTwins, ARowsValueDoesNotDependOnWhichTileItIsIn) {
    for (const MetricId metric : metrics()) {
        const exact::Case all = make(metric, 5, 33, Kind::ordinary, 12);
        std::vector<std::uint32_t> alone;
        for (std::uint32_t row = 0; row < 5; ++row) {
            exact::Case one = all;
            one.rows = 3;
            one.targets.clear();
            for (int copy = 0; copy < 3; ++copy)
                one.targets.insert(one.targets.end(), all.targets.begin() + row * 33,
                                   all.targets.begin() + (row + 1) * 33);
            alone.push_back(bits(run(one, {}).delta));
        }
        std::sort(alone.begin(), alone.end());
        for (std::uint32_t n = 1; n <= 5; ++n) {
            EXPECT_EQ(bits(run(all, {etlmon::AggregationId::kth, n}).delta), alone[n - 1])
                << describe(all, {}, "rows");
        }
    }
}
#endif

}  // namespace
