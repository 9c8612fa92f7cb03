// Distances to int8 rows in integers: every version gives the same bits, the interval holds the
// distance to the float32 rows in real arithmetic and as any version of the kernel measures it, and
// is no wider than the two moves make it.
#include <gtest/gtest.h>

#include <cmath>

#include "enclosed_cases.hpp"
#include "etlmon/dynamic_enclosed.hpp"
#include "kernel_versions.hpp"

namespace {

using namespace kernel_cases;
using etlmon::AggregationId;
using etlmon::ByteRows;
using etlmon::Enclosed;
using etlmon::Measured;
using etlmon::MetricId;
using etlmon::detail::ScaledRows;
using etlmon::detail::Sizes;

constexpr std::uint32_t kLengths[] = {65, 79, 127, 128, 129, 192, 384, 511, 1000, 2049};
constexpr std::uint32_t kNumbers[] = {8, 9, 11, 14, 16, 31};

/// Float32 rows as the kernels want them, and their copies in int8.
struct Rows {
    exact::Case wide;
    std::vector<float> prepared;
    std::vector<std::int8_t> bytes;
    std::vector<std::int32_t> sums;
    float scale = 0, moved = 0;

    ByteRows view() const {
        return {bytes.data(), sums.data(), scale, moved, wide.rows, wide.dimension};
    }
};

Rows rows_of(exact::Case wide, float scale) {
    Rows rows{std::move(wide), {}, {}, {}, scale, 0};
    const exact::Case& c = rows.wide;
    rows.prepared = c.targets;
    etlmon::prepare(c.metric, rows.prepared.data(), c.rows, c.dimension);
    std::vector<float> narrow;
    for (const float x : rows.prepared) {
        rows.bytes.push_back(static_cast<std::int8_t>(std::lrint(x / scale)));
        narrow.push_back(scale * static_cast<float>(rows.bytes.back()));
    }
    rows.sums.resize(2 * std::size_t{c.rows});
    for (std::size_t i = 0; i < rows.bytes.size(); ++i) {
        rows.sums[i / c.dimension] += rows.bytes[i] * rows.bytes[i];
        rows.sums[c.rows + i / c.dimension] += rows.bytes[i];
    }
    rows.moved = greatest_move(c, narrow);
    return rows;
}

float scale_of(const exact::Case& c) {
    std::vector<float> prepared = c.targets;
    etlmon::prepare(c.metric, prepared.data(), c.rows, c.dimension);
    float greatest = 0;
    for (const float x : prepared) greatest = std::max(greatest, std::abs(x));
    return greatest / 127;
}

struct Answer {
    const char* version;
    Enclosed enclosed;
    Measured measured;
    float moved_z;  ///< how far z was moved at most
};

/// What the versions say that were compiled and that the CPU has.
template <class Metric, class Aggregation>
std::vector<Answer> answers([[maybe_unused]] const Rows& rows,
                            [[maybe_unused]] Aggregation aggregation) {
    std::vector<Answer> all;
#if defined(ETLMON_X86_64)
    const exact::Case& c = rows.wide;
    std::vector<std::uint8_t> scratch(etlmon::detail::bytes_scratch(c.dimension));
    const std::uint32_t averaged = Aggregation::kOfDistances ? c.rows : 0;
    const auto ask = [&](const char* version, auto run) {
        const etlmon::detail::Approximate of =
            run(c.z.data(), ScaledRows{rows.bytes.data(), rows.scale}, rows.sums.data(),
                scratch.data(), Sizes{c.rows, c.dimension}, aggregation);
        all.push_back(
            {version,
             etlmon::detail::enclose_integers<Metric>(of, rows.moved, c.dimension, averaged),
             of.measured, of.moved});
    };
    ask("baseline", etlmon::detail::baseline::bytes::run<Metric, Aggregation, Sizes>);
#if defined(ETLMON_DISPATCH)
    const std::uint32_t level = etlmon::detail::x86_64_level();
#if ETLMON_X86_64 < 3
    if (level >= 3) ask("v3", etlmon::detail::x86_64_v3::bytes::run<Metric, Aggregation, Sizes>);
#endif
    if (level >= 4) ask("v4", etlmon::detail::x86_64_v4::bytes::run<Metric, Aggregation, Sizes>);
    if (level >= 4 && etlmon::detail::multiplies_bytes())
        ask("v4, VNNI", etlmon::detail::x86_64_v4::vnni::run<Metric, Aggregation, Sizes>);
#elif ETLMON_X86_64 == 4 && defined(__AVX512VNNI__)
    ask("VNNI", etlmon::detail::x86_64_v4::vnni::run<Metric, Aggregation, Sizes>);
#endif
#endif
    return all;
}

/// No further from the exact distance than the moves and the roundings of both measurements allow.
double widest(MetricId metric, const Rows& rows, const Answer& answer) {
    const double m = double{rows.moved} + double{answer.moved_z}, d = double{answer.measured.delta};
    const double roundings = 3 * etlmon::rounding_bound(metric, rows.wide.dimension, d + m) +
                             2 * etlmon::mean_bound(rows.wide.rows, d + m) + 1e-4 * m;
    const double root = std::sqrt(d) + 1e-3;
    return metric == MetricId::l2sq     ? m * (2 * root + m) * 1.01 + roundings
           : metric == MetricId::cosine ? m * (1.4143 * root + m) * 1.01 + roundings
                                        : 1.6001 * m + roundings;
}

template <class Metric, class Aggregation>
void expect_enclosed(const Rows& rows, MetricId metric, exact::Aggregate aggregate,
                     Aggregation aggregation, bool fits, const std::string& what) {
    const exact::Case& c = rows.wide;
    const double exact = aggregated(c, aggregate);
    const auto wide = row_versions<const float*>(metric, aggregate.id);
    std::vector<Answer> all = answers<Metric>(rows, aggregation);
    const std::size_t known = all.size();
    std::vector<std::uint8_t> scratch(etlmon::detail::bytes_scratch(c.dimension));
    std::vector<float> kept(c.rows);
    const Enclosed chosen = etlmon::measure_bytes(metric, aggregate.id, aggregate.n, c.z.data(),
                                                  rows.view(), scratch.data(), kept.data());
    all.push_back({"chosen", chosen, chosen.measured, 0});
    for (std::size_t v = 0; v < all.size(); ++v) {
        const Answer& a = all[v];
        const std::string where = std::string(a.version) + ": " + what;
        const bool bounded = etlmon::is_finite(a.enclosed.high);
        ASSERT_TRUE(v == known || bounded == fits) << where;
        if (bounded) {
            ASSERT_LE(double{a.enclosed.low}, exact * (1 + 1e-12) + 1e-15) << where;
            ASSERT_GE(double{a.enclosed.high}, exact * (1 - 1e-12) - 1e-15) << where;
        }
        if (bounded && v < known) {
            const double half = widest(metric, rows, a);
            ASSERT_LE(double{a.enclosed.high} - double{a.measured.delta}, half) << where;
        }
#if !defined(__FAST_MATH__)
        // Directions begin with a length in float32, which versions that fuse do not round as the
        // others do.
        if (v > 0 && v < known && etlmon::distance(metric).prepared == etlmon::Prepared::as_given) {
            ASSERT_EQ(bits(a.measured.delta), bits(all[0].measured.delta)) << where;
            ASSERT_EQ(a.measured.nearest, all[0].measured.nearest) << where;
        }
#endif
        for (const auto& version : wide) {
            const Measured of_rows = version.measure(c, rows.prepared.data(), aggregate);
            const etlmon::Cut at[] = {of_rows.delta};
            ASSERT_TRUE(a.enclosed.doubtful(at)) << version.name << ", " << where;
            if (!bounded) continue;
            ASSERT_LE(a.enclosed.low, of_rows.delta) << version.name << ", " << where;
            ASSERT_GE(a.enclosed.high, of_rows.delta) << version.name << ", " << where;
        }
    }
}

template <class Metric>
void expect_case(MetricId metric, const Rows& rows, const char* kind, bool fits = true) {
    std::vector<float> kept(rows.wide.rows);
    const std::uint32_t n = (rows.wide.rows + 1) / 2;
    const auto expect = [&](exact::Aggregate aggregate, auto aggregation) {
        if (testing::Test::HasFatalFailure()) return;
        expect_enclosed<Metric>(rows, metric, aggregate, aggregation, fits,
                                describe(rows.wide, aggregate, kind));
    };
    expect({AggregationId::min, 1}, etlmon::Min{});
    expect({AggregationId::mean, 1}, etlmon::Mean{});
    expect({AggregationId::max, 1}, etlmon::Max{});
    expect({AggregationId::kth, n}, etlmon::KthOf{kept.data(), n, 0});
}

/// z at distances from 0 to far beyond the rows, over all of which the grid changes, and where it
/// ends.
template <class Metric>
void expect_scaled(MetricId metric, Rows rows) {
    const std::vector<float> z = rows.wide.z;
    for (const float factor : {1e-30F, 1e-6F, 1e-3F, 0.02F, 0.3F, 7.0F, 100.0F, 3e3F}) {
        for (std::size_t i = 0; i < z.size(); ++i) rows.wide.z[i] = factor * z[i];
        const bool no_length =
            etlmon::distance(metric).zero_is_unknown && factor < 1e-12F;  // its square vanishes
        expect_case<Metric>(metric, rows, "scaled", !no_length);
    }
    if (etlmon::distance(metric).zero_is_unknown) return;
    for (const float factor : {1e6F, 1e18F, 5e37F}) {
        for (std::size_t i = 0; i < z.size(); ++i) rows.wide.z[i] = factor * z[i];
        expect_case<Metric>(metric, rows, "far", false);
    }
    std::fill(rows.wide.z.begin(), rows.wide.z.end(), 0.0F);
    expect_case<Metric>(metric, rows, "zero");
    std::fill(rows.wide.z.begin(), rows.wide.z.end(), 1e-42F);
    expect_case<Metric>(metric, rows, "denormal");
}

template <class Metric>
void expect_metric(MetricId metric) {
    for (const std::uint32_t dimension : kLengths) {
        for (const std::uint32_t number : kNumbers) {
            if (dimension * number > 6000 && number != 8) continue;
            for (const Kind kind : {Kind::ordinary, Kind::near_target, Kind::touching, Kind::equal,
                                    Kind::mixed, Kind::opposite}) {
                if (kind == Kind::mixed && etlmon::distance(metric).zero_is_unknown) continue;
                const exact::Case c = make(metric, number, dimension, kind, 43);
                const Rows rows = rows_of(c, scale_of(c));
                expect_case<Metric>(metric, rows, name(kind));
                if (kind == Kind::ordinary && dimension * number < 2000)
                    expect_scaled<Metric>(metric, rows);
                if (testing::Test::HasFatalFailure()) return;
            }
        }
    }
}

TEST(InIntegers, L2) {
    expect_metric<etlmon::L2>(MetricId::l2);
}
TEST(InIntegers, L2Sq) {
    expect_metric<etlmon::L2Sq>(MetricId::l2sq);
}
TEST(InIntegers, Cosine) {
    expect_metric<etlmon::Cosine>(MetricId::cosine);
}
TEST(InIntegers, Angular) {
    expect_metric<etlmon::Angular>(MetricId::angular);
}

#if defined(ETLMON_X86_64)
/// Rows that the bytes hold exactly, and z as far from one as rounding can hide: just below half a
/// step of its grid in every element, where all that is measured is 0 and all of the distance is
/// what z was moved by. A bound of 0.499 steps an element fails here.
TEST(InIntegers, MovesOfZ) {
    constexpr std::uint32_t kRow = 3, kNumber = 9;
    for (const std::uint32_t dimension : {65U, 384U, 1000U}) {
        exact::Case c = make(MetricId::l2, kNumber, dimension, Kind::ordinary, 47);
        constexpr float kScale = 0x1p-5F;
        for (float& x : c.targets)
            x = kScale * std::round(std::min(3.9F, std::max(-3.9F, x)) / kScale);
        c.targets[kRow * std::size_t{dimension}] = kScale * 127;  // so that the grid is scale / 64
        constexpr float kUnit = kScale / 64;
        for (std::size_t i = 0; i < dimension; ++i)
            c.z[i] = c.targets[kRow * dimension + i] + (i == 0       ? 0.0F
                                                        : i % 2 == 0 ? -1.0F
                                                                     : 1.0F) *
                                                           0.4999F * kUnit;
        const Rows rows = rows_of(c, kScale);
        ASSERT_LE(rows.moved, 1e-30F);
        const double exact = aggregated(c, {AggregationId::min, 1});
        ASSERT_GT(exact, 0.499 * double{kUnit} * std::sqrt(dimension - 1.0));
        for (const Answer& a : answers<etlmon::L2>(rows, etlmon::Min{})) {
            EXPECT_EQ(a.measured.delta, 0) << a.version;
            EXPECT_EQ(a.measured.nearest, kRow) << a.version;
            EXPECT_GE(double{a.enclosed.high}, exact) << a.version;
            EXPECT_LE(double{a.enclosed.high}, 0.515 * double{kUnit} * std::sqrt(dimension))
                << a.version;
        }
    }
}

/// |z - g|^2 from integers is exact: with z on the grid too, it is that of double arithmetic,
/// rounded, however near.
TEST(InIntegers, NothingCancels) {
    constexpr std::uint32_t kDimension = 384, kNumber = 12;
    constexpr float kScale = 0x1p-5F, kUnit = kScale / 64;
    exact::Case c = make(MetricId::l2sq, kNumber, kDimension, Kind::ordinary, 53);
    for (float& x : c.targets) x = kScale * std::round(std::min(3.9F, std::max(-3.9F, x)) / kScale);
    c.targets[0] = kScale * 127;
    for (const int steps : {0, 1, 2, 3, 100, 4000}) {
        std::copy_n(c.targets.begin(), kDimension, c.z.begin());
        c.z[kDimension - 1] -= kUnit * static_cast<float>(steps % 128),
            c.z[7] -= kUnit * static_cast<float>(steps);
        const Rows rows = rows_of(c, kScale);
        const auto exact = static_cast<float>(aggregated(c, {AggregationId::min, 1}));
        for (const Answer& a : answers<etlmon::L2Sq>(rows, etlmon::Min{}))
            EXPECT_EQ(a.measured.delta, exact) << a.version << ", " << steps;
    }
}

/// Products as large as they can be: every byte is the greatest, and every element of z the
/// greatest of its grid.
TEST(InIntegers, GreatestSums) {
    for (const std::uint32_t dimension : {2047U, 2111U, 16384U}) {
        exact::Case c = make(MetricId::l2, 8, 1, Kind::ordinary, 67);
        c.dimension = dimension;
        c.targets.assign(std::size_t{8} * dimension, 127.0F);
        for (const float x : {127.9F, 127.0F, 63.9F, -63.9F, 2047.0F, -8100.0F}) {
            c.z.assign(dimension, x);
            const Rows rows = rows_of(c, 1.0F);
            const double exact = aggregated(c, {AggregationId::min, 1});
            for (const Answer& a : answers<etlmon::L2>(rows, etlmon::Min{})) {
                ASSERT_LE(double{a.enclosed.low}, exact * (1 + 1e-12))
                    << a.version << ", " << dimension << ", " << x;
                ASSERT_GE(double{a.enclosed.high}, exact * (1 - 1e-12))
                    << a.version << ", " << dimension << ", " << x;
            }
        }
    }
}

/// The lowest of rows that are equally near; one, two or three rows more than whole tiles have.
TEST(InIntegers, TiesGoToTheLowestRow) {
    for (const std::uint32_t number : {8U, 9U, 10U, 11U, 12U, 15U, 33U}) {
        exact::Case c = make(MetricId::l2, number, 70, Kind::ordinary, 59);
        for (std::uint32_t first = 0; first < number; ++first) {
            exact::Case tied = c;
            for (std::uint32_t row = first; row < number; row += 3)
                std::copy_n(c.z.begin(), 70, tied.targets.begin() + std::ptrdiff_t{70} * row);
            for (const Answer& a :
                 answers<etlmon::L2>(rows_of(tied, scale_of(tied)), etlmon::Min{}))
                ASSERT_EQ(a.measured.nearest, first) << a.version << ", " << number;
        }
    }
}

TEST(InIntegers, WhatDoesNotFitIsDoubtful) {
    exact::Case c = make(MetricId::cosine, 9, 100, Kind::ordinary, 61);
    Rows rows = rows_of(c, scale_of(c));
    const auto expect_doubtful = [&](const char* what) {
        const etlmon::Cut never[] = {-5.0F};
        for (const Answer& a : answers<etlmon::Cosine>(rows, etlmon::Min{}))
            EXPECT_TRUE(a.enclosed.doubtful(never)) << a.version << ", " << what;
    };
    rows.moved = 0.3F;
    expect_doubtful("rows that moved too far");
    rows.moved = 0.01F;
    rows.scale = 1e-20F;
    expect_doubtful("a tiny scale");
    rows.scale = 1e20F;
    expect_doubtful("a huge scale");
    rows.scale = 0.01F;
    std::fill(rows.wide.z.begin(), rows.wide.z.end(), 0.0F);
    expect_doubtful("no direction");
}
#endif

inline constexpr std::int8_t kBytes[8 * 66] = {1, -127, 127, 0, 5, -7};
inline constexpr std::int32_t kSums[2 * 8] = {
    1 + 2 * 127 * 127 + 25 + 49, 0, 0, 0, 0, 0, 0, 0, 1 + 5 - 7};

/// As generated code calls it.
TEST(InIntegers, Constants) {
    float z[66] = {0.5F, -63.5F, 63.5F, 1.5F, 2.5F, -3.5F};
    const Enclosed e =
        etlmon::measure_bytes<etlmon::L2, etlmon::Min, 8, 66, kBytes, kSums>(z, 0.5F, 0.001F);
    EXPECT_EQ(e.measured.nearest, 0U);
    EXPECT_NEAR(e.measured.delta, 1.5F, 0.04F);
    EXPECT_LE(e.low, 1.5F);
    EXPECT_GE(e.high, 1.5F);
    EXPECT_LE(e.high - e.low, 0.08F);
}

}  // namespace
