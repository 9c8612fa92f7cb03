// Rows of float16 and int8: the same bits as the rows of float32 that they widen to, in every version of the kernel,
// and so within the same bounds. Subnormals, zeros and the greatest numbers of either are among the rows.
#include <gtest/gtest.h>

#include <cmath>

#include "kernel_versions.hpp"

namespace {

using namespace kernel_cases;
using etlmon::Measured;
using etlmon::MetricId;
using etlmon::detail::ScaledRows;
using etlmon::detail::Sizes;

/// A float16 by its definition (IEEE 754, 3.4 and 3.6).
float half(std::uint16_t bits) {
    const int exponent = (bits >> 10) & 0x1f, fraction = bits & 0x3ff;
    const double magnitude =
        exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(1024 + fraction, exponent - 25);  // finite ones only
    return static_cast<float>((bits & 0x8000) != 0 ? -magnitude : magnitude);
}

TEST(NarrowRows, EveryHalfWidensToItself) {
    for (std::uint32_t bits_of_half = 0; bits_of_half < 0x10000; ++bits_of_half) {
        if ((bits_of_half & 0x7c00) == 0x7c00) continue;  // views.hpp keeps what is not finite from the kernels
        const auto narrow = static_cast<std::uint16_t>(bits_of_half);
        const float one = half(narrow);
        ASSERT_EQ(bits(etlmon::detail::element(&narrow, 0)), bits(one)) << bits_of_half;
        std::uint16_t many[19];
        float widened[19];
        std::fill(many, many + 19, narrow);
        etlmon::widen_f16(many, widened, 19);
        for (const float x : widened) ASSERT_EQ(bits(x), bits(one)) << bits_of_half;
    }
}

/// A case, and its rows in narrow storage.
struct Narrow {
    exact::Case wide;
    std::vector<std::uint16_t> halves;
    std::vector<std::int8_t> bytes;
    float scale = 0;
};

enum class Storage { f16, i8 };

std::uint16_t random_half(std::mt19937& random, Kind kind) {
    const auto sign = static_cast<std::uint16_t>((random() & 1) << 15);
    const std::uint32_t fraction = random() & 0x3ff;
    const std::uint32_t exponent = kind == Kind::denormal ? random() % 2  // subnormal, or the least normal ones
                                   : kind == Kind::huge   ? 29 + random() % 2
                                   : kind == Kind::mixed  ? random() % 31
                                                          : 12 + random() % 4;
    return static_cast<std::uint16_t>(sign | exponent << 10 | fraction | (fraction == 0 && exponent == 0 ? 1 : 0));
}

Narrow make_narrow(Storage storage, MetricId metric, std::uint32_t rows, std::uint32_t dimension, Kind kind) {
    Narrow narrow{make(metric, rows, dimension, Kind::ordinary, 31), {}, {}, 0};
    std::mt19937 random(rows * 1009 + dimension);
    narrow.scale = kind == Kind::denormal ? 3e-40F : kind == Kind::huge ? 1e35F : 0.0173F;
    for (std::size_t i = 0; i < narrow.wide.targets.size(); ++i) {
        narrow.halves.push_back(random_half(random, kind));
        narrow.bytes.push_back(static_cast<std::int8_t>(random() % 256 - 128));
        narrow.wide.targets[i] =
            storage == Storage::f16 ? half(narrow.halves[i]) : narrow.scale * static_cast<float>(narrow.bytes[i]);
    }
    const std::size_t row = random() % rows * dimension;
    std::normal_distribution<float> normal;
    for (std::size_t i = 0; i < dimension; ++i) {
        float& z = narrow.wide.z[i];
        if (kind == Kind::equal) z = narrow.wide.targets[row + i];
        if (kind == Kind::near_target) z = narrow.wide.targets[row + i] * (1 + 1e-5F * normal(random));
    }
    return narrow;
}

template <class Metric, class Aggregation, class G>
void expect_same(const Narrow& narrow, G rows, exact::Aggregate aggregate, Aggregation aggregation, const char* kind) {
    const exact::Case& c = narrow.wide;
    const exact::Judge judge(c, kDenormals);
    const Sizes size{c.rows, c.dimension};
    const auto wide = versions<Metric, Aggregation, Sizes, false, const float*>();
    const auto direct = versions<Metric, Aggregation, Sizes, false, G>();
    for (std::size_t v = 0; v < wide.size(); ++v) {
        const Measured m = direct[v].run(c.z.data(), rows, c.weights.data(), size, aggregation);
        const Measured of_wide = wide[v].run(c.z.data(), c.targets.data(), c.weights.data(), size, aggregation);
        ASSERT_EQ(bits(m.delta), bits(of_wide.delta)) << direct[v].name << ": " << describe(c, aggregate, kind);
        ASSERT_EQ(m.nearest, of_wide.nearest) << direct[v].name << ": " << describe(c, aggregate, kind);
        if (etlmon::distance(c.metric).prepared == etlmon::Prepared::as_given) {
            ASSERT_EQ(judge.mismatch(aggregate, bits(m.delta), m.nearest), "")
                << direct[v].name << ": " << describe(c, aggregate, kind);
        }
    }
}

template <class Metric, class G>
void expect_every_aggregation(const Narrow& narrow, G rows, const char* kind) {
    using Id = etlmon::AggregationId;
    std::vector<float> scratch(narrow.wide.rows);
    const std::uint32_t n = (narrow.wide.rows + 1) / 2;
    expect_same<Metric>(narrow, rows, {Id::min, 1}, etlmon::Min{}, kind);
    expect_same<Metric>(narrow, rows, {Id::max, 1}, etlmon::Max{}, kind);
    expect_same<Metric>(narrow, rows, {Id::mean, 1}, etlmon::Mean{}, kind);
    expect_same<Metric>(narrow, rows, {Id::kth, n}, etlmon::KthOf{scratch.data(), n, 0}, kind);
}

template <class Metric>
void expect_metric(MetricId metric) {
    for (const std::uint32_t dimension : kDimensions) {
        for (const std::uint32_t rows : kRows) {
            if (metric == MetricId::mahalanobis && dimension * rows > 1000) continue;
            for (const Kind kind :
                 {Kind::ordinary, Kind::near_target, Kind::equal, Kind::mixed, Kind::huge, Kind::denormal}) {
                if (dimension * rows > 2000 && kind != Kind::ordinary && kind != Kind::equal) continue;
                const Narrow halves = make_narrow(Storage::f16, metric, rows, dimension, kind);
                expect_every_aggregation<Metric>(halves, static_cast<const std::uint16_t*>(halves.halves.data()),
                                                 name(kind));
                const Narrow bytes = make_narrow(Storage::i8, metric, rows, dimension, kind);
                expect_every_aggregation<Metric>(bytes, ScaledRows{bytes.bytes.data(), bytes.scale}, name(kind));
                if (testing::Test::HasFatalFailure()) return;
            }
        }
    }
}

#define DISTANCE(id, Type, low, high, prepared, zero_is_unknown) \
    TEST(NarrowRows, SameAsWidened_##id) {                       \
        expect_metric<etlmon::Type>(MetricId::id);               \
    }
#include "etlmon/distances.def"
#undef DISTANCE

inline constexpr std::uint16_t kHalves[64 * 5] = {0x3c00, 0x4001, 0x8001, 0x3555, 0xbbbb, 0x7bff, 0x0400};
inline constexpr float kWideHalves[64 * 5] = {1.0F,        2.001953125F, -5.9604645e-8F, 0.333251953125F,
                                              -0.9663086F, 65504.0F,     6.1035156e-5F};
inline constexpr std::int8_t kBytes[64 * 5] = {1, -128, 127, 0, 5, -7};
inline constexpr float kWideBytes[64 * 5] = {0.5F, -64.0F, 63.5F, 0.0F, 2.5F, -3.5F};

/// Columns, in which the compiler keeps constants.
TEST(NarrowRows, InColumns) {
    using namespace etlmon;
    const float z[5] = {1.5F, -0.25F, 3.0F, 1e-3F, -1.0F};
    const Measured f16 = measure<L2, Min, 64, 5, kHalves>(z), wide16 = measure<L2, Min, 64, 5, kWideHalves>(z);
    EXPECT_EQ(bits(f16.delta), bits(wide16.delta));
    EXPECT_EQ(f16.nearest, wide16.nearest);
    const Measured i8 = measure_scaled<L1, Max, 64, 5, kBytes>(z, 0.5F), wide8 = measure<L1, Max, 64, 5, kWideBytes>(z);
    EXPECT_EQ(bits(i8.delta), bits(wide8.delta));
    EXPECT_EQ(i8.nearest, wide8.nearest);
}

}  // namespace
