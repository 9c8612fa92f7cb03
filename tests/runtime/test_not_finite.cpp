// A point with an element that is not finite has no distance with any kernel: NaN, and row 0.
#include <gtest/gtest.h>

#include <algorithm>

#include "kernel_versions.hpp"

namespace {

using namespace kernel_cases;
using etlmon::Measured;
using etlmon::MetricId;

const std::vector<std::uint32_t> kNotFinite{0x7fc00000, 0xffc00000, 0x7f800001, 0x7f800000,
                                            0xff800000};

void put(exact::Case& c, std::uint32_t element, std::uint32_t bits_of_element) {
    std::memcpy(&c.z[element], &bits_of_element, sizeof(float));
}

void expect_unmeasured(Measured m, const exact::Case& c, exact::Aggregate aggregate,
                       const char* version) {
    ASSERT_TRUE(etlmon::is_nan(m.delta)) << version << ": " << describe(c, aggregate, "not finite");
    ASSERT_EQ(m.nearest, 0u) << version << ": " << describe(c, aggregate, "not finite");
}

void expect_row_versions(const exact::Case& c, const float* rows) {
    for (const exact::Aggregate aggregate : aggregates(c.rows, true))
        for (const auto& version : row_versions<const float*>(c.metric))
            expect_unmeasured(version.measure(c, rows, aggregate), c, aggregate, version.name);
}

class NotFinite : public testing::TestWithParam<MetricId> {};

TEST_P(NotFinite, NoDistanceToRows) {
    std::mt19937 random(31);
    for (const std::uint32_t dimension : kDimensions) {
        for (const std::uint32_t rows : rows_of(GetParam(), dimension)) {
            const exact::Case finite = make(GetParam(), rows, dimension, Kind::ordinary, 31);
            std::vector<float> prepared = finite.targets;
            etlmon::prepare(GetParam(), prepared.data(), rows, dimension);
            for (const std::uint32_t not_finite : kNotFinite) {
                if (is_heavy(GetParam(), rows, dimension) && random() % 4 != 0) continue;
                exact::Case c = finite;
                put(c, static_cast<std::uint32_t>(random() % dimension), not_finite);
                expect_row_versions(c, prepared.data());
                if (HasFatalFailure()) return;
            }
        }
    }
}

TEST_P(NotFinite, NoDistanceWhateverElse) {
    for (const Kind kind : {Kind::equal, Kind::huge, Kind::denormal}) {
        exact::Case c = make(GetParam(), 5, 33, kind, 32);
        std::vector<float> prepared = c.targets;
        etlmon::prepare(GetParam(), prepared.data(), 5, 33);
        put(c, 7, 0xff800000);
        expect_row_versions(c, prepared.data());
        put(c, 32, 0xffc00000);
        expect_row_versions(c, prepared.data());
    }
}

INSTANTIATE_TEST_SUITE_P(All, NotFinite, testing::ValuesIn(metrics()), [](const auto& of) {
    return std::string(etlmon::distance(of.param).word);
});

template <class Metric, class Aggregation, std::uint32_t K, std::uint32_t D>
void expect_columns(MetricId metric) {
    using namespace etlmon::detail;
    static float rows[K * D];
    const exact::Case finite = make(metric, K, D, Kind::ordinary, 33);
    std::copy(finite.targets.begin(), finite.targets.end(), rows);
    etlmon::prepare(metric, rows, K, D);
    const Columns<K, D> columns = columns_of<K, D>(rows);
    for (std::uint32_t element = 0; element < D; ++element) {
        for (const std::uint32_t not_finite : kNotFinite) {
            exact::Case c = finite;
            put(c, element, not_finite);
            const Measured m = best<Metric, Aggregation, Fixed<K, D>, true>(
                c.z.data(), columns.values, c.weights.data(), {}, {});
            expect_unmeasured(m, c, {}, "columns");
        }
    }
}

TEST(NotFinite, NoDistanceToColumns) {
    expect_columns<etlmon::L2, etlmon::Min, 64, 2>(MetricId::l2);
    expect_columns<etlmon::Linf, etlmon::Max, 64, 33>(MetricId::linf);
    expect_columns<etlmon::L1, etlmon::Min, 17, 3>(MetricId::l1);
    expect_columns<etlmon::Angular, etlmon::Kth<3>, 8, 3>(MetricId::angular);
    expect_columns<etlmon::MahalanobisDiagonal, etlmon::Mean, 8, 3>(MetricId::mahalanobis_diagonal);
}

inline constexpr float kTargets[4] = {0, 0, 3, 4};
inline constexpr float kLongTargets[5 * 33] = {1, 2, 3};

TEST(NotFinite, SamplesAndPoints) {
    using namespace etlmon;
    const auto measured = [](Vector<float, 2> z) { return measure<L2, Min, 2, 2, kTargets>(z); };
    const float missing = kMissing;
    const float z[2] = {3, 3}, incomplete[2] = {missing, 3};
    EXPECT_NEAR(measured(z).delta, 1.0F, 1e-6F);
    EXPECT_EQ(measured(z).nearest, 1u);
    EXPECT_TRUE(is_nan(measured(incomplete).delta));
    EXPECT_TRUE(is_nan(measured({}).delta));
    EXPECT_TRUE(is_nan((measure<Cosine, Max, 5, 33, kLongTargets>(Vector<float, 33>{}).delta)));
    EXPECT_TRUE(is_nan((measure<L1, Mean, 5, 33, kLongTargets>(Vector<float, 33>{}).delta)));
    EXPECT_EQ((measure<Linf, Kth<2>, 5, 33, kLongTargets>(Vector<float, 33>{}).nearest), 0u);
    EXPECT_NEAR((measure<L2, Min, 2, 2, kTargets>({z[0], z[1]}).delta), 1.0F, 1e-6F);
    EXPECT_TRUE(is_nan(measure<L2, Min, 2, 2, kTargets>({z[0], missing}).delta));
}

/// A compiler that assumes no NaN sees a scalar outside its range as a choice between a number and
/// a NaN.
TEST(NotFinite, ScalarsOutsideTheirRanges) {
    using namespace etlmon;
    volatile float outside = 2, inside = 0.5F;
    const auto measured = [](const float& x, const float& y) {
        return measure<L2, Min, 2, 2, kTargets>({accept(x, 0.0F, 1.0F), accept(y)}).delta;
    };
    const float two = outside, half = inside;
    EXPECT_TRUE(is_nan(measured(two, half)));
    EXPECT_NEAR(measured(half, two), 2.0615528F, 1e-5F);
}

}  // namespace
