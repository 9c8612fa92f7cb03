// The distance between two points: every metric, with both points of any length, against exact.hpp;
// points that are missing or have no direction; and what points are put together from.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>

#include "etlmon/distance/between.hpp"
#include "kernel_cases.hpp"

namespace {

using namespace kernel_cases;
using etlmon::Measured;
using etlmon::MetricId;

template <std::uint32_t Dim>
Measured between(const exact::Case& c) {
    const float* a = c.z.data();
    const float* b = c.targets.data();
    const float* weights = c.weights.empty() ? nullptr : c.weights.data();
    switch (c.metric) {
#define DISTANCE(id, Type, prepared, zero_is_unknown) \
    case MetricId::id:                                \
        return etlmon::measure_between<etlmon::Type, Dim>(a, b, weights);
#include "etlmon/distance/distances.def"
#undef DISTANCE
    }
    return etlmon::kUnmeasured;
}

Measured between(const exact::Case& c) {
    switch (c.dimension) {
        case 1: return between<1>(c);
        case 2: return between<2>(c);
        case 3: return between<3>(c);
        case 7: return between<7>(c);
        case 33: return between<33>(c);
        default: return between<384>(c);
    }
}

const std::vector<std::uint32_t> kPointDimensions{1, 2, 3, 7, 33, 384};

void expect_between(const exact::Case& c, const char* kind) {
    const exact::Judge judge(c, kFlushesDenormals, exact::Rows::point);
    const Measured m = between(c);
    ASSERT_EQ(judge.mismatch({}, bits(m.delta), m.nearest), "")
        << describe(c, {}, kind) << ", |z| " << c.z[0] << "..., other " << c.targets[0] << "...";
}

class Between : public testing::TestWithParam<MetricId> {};

TEST_P(Between, WithinTheirBounds) {
    for (const std::uint32_t dimension : kPointDimensions)
        for (const Kind kind : kKinds)
            for (std::uint32_t seed = 1; seed < (dimension > 7 ? 4U : 40U); ++seed) {
                expect_between(make(GetParam(), 1, dimension, kind, seed), name(kind));
                if (HasFatalFailure()) return;
            }
}

/// Scales of points. Where denormals are flushed, those that lose no elements.
std::vector<float> scales() {
    std::vector<float> all{1, 1e-13F, 1e-12F, 1e-24F, 1e15F, 1e18F, 1e20F, 8e37F};
    if (!kFlushesDenormals) all.insert(all.end(), {1e-36F, 3e-38F, 1e-38F, 1e-40F, 1e-43F, 3e-45F});
    return all;
}

/// Scales a point, but to finite elements.
void scale(std::vector<float>& point, float by) {
    constexpr float kMost = std::numeric_limits<float>::max();
    for (float& x : point) x = std::min(kMost, std::max(-kMost, x * by));
}

TEST_P(Between, PointsOfAllLengths) {
    for (const std::uint32_t dimension : kPointDimensions) {
        if (is_heavy(GetParam(), 1, dimension)) continue;
        for (const Kind kind : {Kind::ordinary, Kind::touching, Kind::equal, Kind::opposite})
            for (const float of_a : scales())
                for (const float of_b : scales())
                    for (std::uint32_t seed = 1; seed < (dimension > 33 ? 2U : 5U); ++seed) {
                        exact::Case c = make(GetParam(), 1, dimension, kind, 50 + seed);
                        scale(c.z, of_a);
                        scale(c.targets, of_b);
                        expect_between(c, name(kind));
                        if (HasFatalFailure()) return;
                    }
    }
}

// An element that is much larger than the rest decides the scale; squares of the rest vanish.
TEST_P(Between, ElementsOfAllSizes) {
    for (const std::uint32_t dimension : {2U, 7U, 33U})
        for (const float large : scales())
            for (const float small : scales())
                for (const bool both : {false, true}) {
                    exact::Case c = make(GetParam(), 1, dimension, Kind::ordinary, dimension);
                    scale(c.z, small);
                    if (both) scale(c.targets, small);
                    c.targets[dimension / 2] = large;
                    if (both) c.z[0] = -large;
                    expect_between(c, "elements of all sizes");
                    if (HasFatalFailure()) return;
                }
}

TEST_P(Between, PointsWithoutADirection) {
    for (const bool first : {false, true})
        for (const float zero : {0.0F, -0.0F}) {
            exact::Case c = make(GetParam(), 1, 7, Kind::ordinary, 60);
            (first ? c.z : c.targets).assign(7, zero);
            expect_between(c, "a zero vector");
            (first ? c.targets : c.z).assign(7, -zero);
            expect_between(c, "two zero vectors");
        }
}

TEST_P(Between, PointsThatAreMissing) {
    exact::Case c = make(GetParam(), 1, 7, Kind::ordinary, 61);
    const auto is_unknown = [](const Measured& m) { return etlmon::is_nan(m.delta); };
    EXPECT_FALSE(is_unknown(between(c)));
    const float* weights = c.weights.data();
    switch (GetParam()) {
#define DISTANCE(id, Type, prepared, zero_is_unknown)                         \
    case MetricId::id: {                                                      \
        const auto measure = etlmon::measure_between<etlmon::Type, 7>;        \
        EXPECT_TRUE(is_unknown(measure(nullptr, c.targets.data(), weights))); \
        EXPECT_TRUE(is_unknown(measure(c.z.data(), nullptr, weights)));       \
        EXPECT_TRUE(is_unknown(measure(nullptr, nullptr, weights)));          \
        break;                                                                \
    }
#include "etlmon/distance/distances.def"
#undef DISTANCE
    }
}

INSTANTIATE_TEST_SUITE_P(All, Between, testing::ValuesIn(metrics()), [](const auto& of) {
    return std::string(etlmon::distance(of.param).word);
});

TEST(PointsPutTogether, OneBehindTheOther) {
    const float first[] = {1, 2}, second[] = {3}, third[] = {4, 5, 6};
    using etlmon::Part;
    float to[6]{};
    const float* all = etlmon::joined(to, Part<2>{first}, Part<1>{second}, Part<3>{third});
    ASSERT_EQ(all, static_cast<const float*>(to));
    for (std::uint32_t i = 0; i < 6; ++i) EXPECT_EQ(bits(to[i]), bits(1 + static_cast<float>(i)));
    EXPECT_EQ(etlmon::joined(to, Part<2>{nullptr}, Part<1>{second}, Part<3>{third}), nullptr);
    EXPECT_EQ(etlmon::joined(to, Part<2>{first}, Part<1>{second}, Part<3>{nullptr}), nullptr);
}

TEST(PointsPutTogether, ScalarsAllOfThem) {
    float to[3]{};
    ASSERT_EQ(etlmon::gathered(to, 1.0F, -2.0F, 3e38F), static_cast<const float*>(to));
    EXPECT_EQ(bits(to[1]), bits(-2.0F));
    for (const std::uint32_t not_finite : {0x7fc00000U, 0x7f800000U, 0xff800000U, 0x7f800001U})
        for (std::uint32_t at = 0; at < 3; ++at) {
            float of[] = {1, 2, 3};
            std::memcpy(&of[at], &not_finite, sizeof(float));
            EXPECT_EQ(etlmon::gathered(to, of[0], of[1], of[2]), nullptr);
        }
}

TEST(PointsAdded, OneAfterTheOther) {
    const float a[] = {1, 3e38F, 0.1F}, b[] = {0.3F, 3e38F, -7}, c[] = {1e-3F, -3e38F, 0};
    float to[3]{};
    ASSERT_EQ(etlmon::summed(to, {{1, a}, {-2.5F, c}, {-0.7F, b}}), nullptr);  // 3e38 + 7.5e38
    ASSERT_EQ(etlmon::summed(to, {{1, a}, {-0.7F, b}, {0.3F, c}}), static_cast<const float*>(to));
    for (std::uint32_t i = 0; i < 3; ++i) {
        volatile float product = -0.7F * b[i];  // rounds once, and is not fused
        volatile float sum = a[i] + product;
        product = 0.3F * c[i];
        sum = sum + product;
        EXPECT_EQ(to[i], sum);
    }
    EXPECT_EQ(etlmon::summed(to, {{1, a}, {1, nullptr}}), nullptr);
    EXPECT_EQ(etlmon::summed(to, {{1, nullptr}, {1, a}}), nullptr);
    ASSERT_NE(etlmon::summed(to, {{-1, a}}), nullptr);
    EXPECT_EQ(bits(to[1]), bits(-3e38F));
}

TEST(PointsPutTogether, NarrowSamplesAsFloats) {
    float to[4]{};
    const std::uint16_t halves[] = {0x3c00, 0xc000, 0x0001, 0x7bff};
    ASSERT_EQ(etlmon::widened(halves, to), static_cast<const float*>(to));
    const float expected[] = {1, -2, 0x1p-24F, 65504};
    for (std::uint32_t i = 0; i < 4; ++i) EXPECT_EQ(bits(to[i]), bits(expected[i]));
    const std::int8_t bytes[] = {-128, -1, 0, 127};
    ASSERT_EQ(etlmon::widened(bytes, 0.25F, to), static_cast<const float*>(to));
    const float scaled[] = {-32, -0.25F, 0, 31.75F};
    for (std::uint32_t i = 0; i < 4; ++i) EXPECT_EQ(bits(to[i]), bits(scaled[i]));
    EXPECT_EQ(etlmon::widened(static_cast<const std::uint16_t*>(nullptr), to), nullptr);
    EXPECT_EQ(etlmon::widened(static_cast<const std::int8_t*>(nullptr), 0.25F, to), nullptr);
}

}  // namespace
