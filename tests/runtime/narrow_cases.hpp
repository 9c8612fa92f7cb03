// Rows of float16 and int8 for the kernel tests. Subnormals, zeros and the greatest numbers of either are among them.
// Takes: a storage, a distance, sizes, a kind of case. Gives: the narrow rows and the float32 rows that they widen to,
// and a check that every version of the kernel gives both the same bits, within the bounds of the definition.
// Keeps true: under sanitizers, where a kernel takes seconds to compile, the nearest row is measured by every version
// and each other aggregation by one, another for every distance; and only where rows have to be of length 1, for which
// the judge knows nothing of others, float32 rows are measured beside.
#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "etlmon/widen.hpp"
#include "kernel_versions.hpp"

namespace narrow_cases {

using namespace kernel_cases;
using etlmon::Measured;
using etlmon::MetricId;
using etlmon::detail::ScaledRows;
using etlmon::detail::Sizes;

#if defined(__SANITIZE_ADDRESS__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

/// A float16 by its definition (IEEE 754, 3.4 and 3.6).
inline float half(std::uint16_t bits) {
    const int exponent = (bits >> 10) & 0x1f, fraction = bits & 0x3ff;
    const double magnitude =
        exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(1024 + fraction, exponent - 25);  // finite ones only
    return static_cast<float>((bits & 0x8000) != 0 ? -magnitude : magnitude);
}

/// A case, and its rows in narrow storage.
struct Narrow {
    exact::Case wide;
    std::vector<std::uint16_t> halves;
    std::vector<std::int8_t> bytes;
    float scale = 0;
};

enum class Storage { f16, i8 };

inline std::uint16_t random_half(std::mt19937& random, Kind kind) {
    const auto sign = static_cast<std::uint16_t>((random() & 1) << 15);
    const std::uint32_t fraction = random() & 0x3ff;
    const std::uint32_t exponent = kind == Kind::denormal ? random() % 2  // subnormal, or the least normal ones
                                   : kind == Kind::huge   ? 29 + random() % 2
                                   : kind == Kind::mixed  ? random() % 31
                                                          : 12 + random() % 4;
    return static_cast<std::uint16_t>(sign | exponent << 10 | fraction | (fraction == 0 && exponent == 0 ? 1 : 0));
}

inline Narrow make_narrow(Storage storage, MetricId metric, std::uint32_t rows, std::uint32_t dimension, Kind kind) {
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

/// The versions that widen whole embeddings.
template <class G>
std::vector<void (*)(G, float*, std::uint32_t) noexcept> widenings() {
    std::vector<void (*)(G, float*, std::uint32_t) noexcept> all{etlmon::detail::baseline::widen<G>};
#if defined(ETLMON_DISPATCH)
    const std::uint32_t level = etlmon::detail::x86_64_level();
#if ETLMON_X86_64 < 3
    if (level >= 3) all.push_back(etlmon::detail::x86_64_v3::widen<G>);
#endif
    if (level >= 4) all.push_back(etlmon::detail::x86_64_v4::widen<G>);
#endif
    return all;
}

/// n elements of every length come out as they do one by one, and nothing is written behind them.
template <class G>
void expect_widened(G from, std::uint32_t greatest) {
    for (const auto widen : widenings<G>()) {
        for (std::uint32_t n = 0; n <= greatest; ++n) {
            std::vector<float> to(n + 1, -1.0F);
            widen(from, to.data(), n);
            for (std::uint32_t i = 0; i < n; ++i) ASSERT_EQ(bits(to[i]), bits(etlmon::detail::element(from, i))) << n;
            ASSERT_EQ(to[n], -1.0F) << n;
        }
    }
}

/// The versions that are compiled for an aggregation, the `turn`-th of a distance.
template <MetricId Id, int Turn>
constexpr Which which() {
    if (!kSanitized || Turn == 0) return Which::all;
    return static_cast<Which>(1 + (static_cast<int>(Id) + Turn) % 3);
}

template <class Metric, MetricId Id, int Turn, class Aggregation, class G>
void expect_same(const Narrow& narrow, G rows, exact::Aggregate aggregate, Aggregation aggregation, const char* kind) {
    const exact::Case& c = narrow.wide;
    const exact::Judge judge(c, kDenormals);
    const Sizes size{c.rows, c.dimension};
    constexpr Which kWhich = which<Id, Turn>();
    constexpr bool kAnyLength = etlmon::kDistances[static_cast<int>(Id)].prepared == etlmon::Prepared::as_given;
    const auto direct = versions<Metric, Aggregation, Sizes, false, G, kWhich>();
    std::vector<Measured> measured;
    for (const auto& version : direct) {
        measured.push_back(version.run(c.z.data(), rows, c.weights.data(), size, aggregation));
        if (!kAnyLength) continue;
        ASSERT_EQ(judge.mismatch(aggregate, bits(measured.back().delta), measured.back().nearest), "")
            << version.name << ": " << describe(c, aggregate, kind);
    }
    if constexpr (!kSanitized || !kAnyLength) {
        const auto wide = versions<Metric, Aggregation, Sizes, false, const float*, kWhich>();
        for (std::size_t v = 0; v < wide.size(); ++v) {
            const Measured of_wide = wide[v].run(c.z.data(), c.targets.data(), c.weights.data(), size, aggregation);
            ASSERT_EQ(bits(measured[v].delta), bits(of_wide.delta))
                << wide[v].name << ": " << describe(c, aggregate, kind);
            ASSERT_EQ(measured[v].nearest, of_wide.nearest) << wide[v].name << ": " << describe(c, aggregate, kind);
        }
    }
}

inline const std::uint16_t* rows_in(const Narrow& narrow, const std::uint16_t*) {
    return narrow.halves.data();
}
inline ScaledRows rows_in(const Narrow& narrow, ScaledRows) {
    return {narrow.bytes.data(), narrow.scale};
}

template <class Metric, MetricId Id, class G>
void expect_every_aggregation(const Narrow& narrow, const char* kind) {
    using Aggregation = etlmon::AggregationId;
    const G rows = rows_in(narrow, G{});
    std::vector<float> scratch(narrow.wide.rows);
    const std::uint32_t n = (narrow.wide.rows + 1) / 2;
    expect_same<Metric, Id, 0>(narrow, rows, {Aggregation::min, 1}, etlmon::Min{}, kind);
    expect_same<Metric, Id, 1>(narrow, rows, {Aggregation::max, 1}, etlmon::Max{}, kind);
    expect_same<Metric, Id, 2>(narrow, rows, {Aggregation::mean, 1}, etlmon::Mean{}, kind);
    expect_same<Metric, Id, 3>(narrow, rows, {Aggregation::kth, n}, etlmon::KthOf{scratch.data(), n, 0}, kind);
}

/// Every size and kind, for rows as G reads them.
template <class Metric, MetricId Id, class G>
void expect_metric(Storage storage) {
    for (const std::uint32_t dimension : kDimensions) {
        for (const std::uint32_t rows : kRows) {
            if (Id == MetricId::mahalanobis && dimension * rows > 1000) continue;
            for (const Kind kind :
                 {Kind::ordinary, Kind::near_target, Kind::equal, Kind::mixed, Kind::huge, Kind::denormal}) {
                if (dimension * rows > 2000 && kind != Kind::ordinary && kind != Kind::equal) continue;
                expect_every_aggregation<Metric, Id, G>(make_narrow(storage, Id, rows, dimension, kind), name(kind));
                if (testing::Test::HasFatalFailure()) return;
            }
        }
    }
}

}  // namespace narrow_cases
