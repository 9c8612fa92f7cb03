// Rows of float16 and int8 for the kernel tests, including subnormals, zeros and the greatest
// numbers. Takes: a storage, a distance, sizes, a kind of case. Gives: the narrow rows, the float32
// rows that they widen to, and a check that every version of the kernel gives both the same bits,
// within the bounds of the definition.
#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "etlmon/distance/widen.hpp"
#include "kernel_versions.hpp"

namespace narrow_cases {

using namespace kernel_cases;
using etlmon::Measured;
using etlmon::MetricId;
using etlmon::detail::ScaledRows;

/// Returns a float16 by its definition (IEEE 754, 3.4 and 3.6).
inline float half(std::uint16_t bits) {
    const int exponent = (bits >> 10) & 0x1f, fraction = bits & 0x3ff;
    const double magnitude = exponent == 0
                                 ? std::ldexp(fraction, -24)
                                 : std::ldexp(1024 + fraction, exponent - 25);  // only finite ones
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
    const std::uint32_t exponent = kind == Kind::denormal
                                       ? random() % 2  // subnormal, or the least normal numbers
                                   : kind == Kind::huge  ? 29 + random() % 2
                                   : kind == Kind::mixed ? random() % 31
                                                         : 12 + random() % 4;
    return static_cast<std::uint16_t>(sign | exponent << 10 | fraction |
                                      (fraction == 0 && exponent == 0 ? 1 : 0));
}

inline Narrow make_narrow(Storage storage, MetricId metric, std::uint32_t rows,
                          std::uint32_t dimension, Kind kind) {
    Narrow narrow{make(metric, rows, dimension, Kind::ordinary, 31), {}, {}, 0};
    std::mt19937 random(rows * 1009 + dimension);
    narrow.scale = kind == Kind::denormal ? 3e-40F : kind == Kind::huge ? 1e35F : 0.0173F;
    for (std::size_t i = 0; i < narrow.wide.targets.size(); ++i) {
        narrow.halves.push_back(random_half(random, kind));
        narrow.bytes.push_back(static_cast<std::int8_t>(random() % 256 - 128));
        narrow.wide.targets[i] = storage == Storage::f16
                                     ? half(narrow.halves[i])
                                     : narrow.scale * static_cast<float>(narrow.bytes[i]);
    }
    const std::size_t row = random() % rows * dimension;
    std::normal_distribution<float> normal;
    for (std::size_t i = 0; i < dimension; ++i) {
        float& z = narrow.wide.z[i];
        if (kind == Kind::equal) z = narrow.wide.targets[row + i];
        if (kind == Kind::near_target)
            z = narrow.wide.targets[row + i] * (1 + 1e-5F * normal(random));
    }
    return narrow;
}

/// The versions that widen whole embeddings.
template <class G>
std::vector<void (*)(G, float*, std::uint32_t) noexcept> widenings() {
    std::vector<void (*)(G, float*, std::uint32_t) noexcept> all{etlmon::detail::widen<G>};
#if defined(ETLMON_VECTORS)
    all.push_back(etlmon::detail::baseline::widen<G>);
#endif
#if defined(ETLMON_DISPATCH)
    const std::uint32_t level = etlmon::detail::x86_64_level();
#if ETLMON_X86_64 < 3
    if (level >= 3) all.push_back(etlmon::detail::x86_64_v3::widen<G>);
#endif
    if (level >= 4) all.push_back(etlmon::detail::x86_64_v4::widen<G>);
#endif
    return all;
}

inline std::vector<Kind> kinds_of(MetricId metric, std::uint32_t rows, std::uint32_t dimension) {
    if (is_heavy(metric, rows, dimension)) return {Kind::ordinary};
    if (rows * dimension > 2000) return {Kind::ordinary, Kind::equal};
    return {Kind::ordinary, Kind::near_target, Kind::equal,
            Kind::mixed,    Kind::huge,        Kind::denormal};
}

/// Checks that n elements of every length widen as they do one by one, and that nothing is written
/// after them.
template <class G>
void expect_widened(G from, std::uint32_t greatest) {
    for (const auto widen : widenings<G>()) {
        for (std::uint32_t n = 0; n <= greatest; ++n) {
            std::vector<float> to(n + 1, -1.0F);
            widen(from, to.data(), n);
            for (std::uint32_t i = 0; i < n; ++i)
                ASSERT_EQ(bits(to[i]), bits(etlmon::detail::element(from, i))) << n;
            ASSERT_EQ(to[n], -1.0F) << n;
        }
    }
}

inline const std::uint16_t* rows_in(const Narrow& narrow, const std::uint16_t*) {
    return narrow.halves.data();
}
inline ScaledRows rows_in(const Narrow& narrow, ScaledRows) {
    return {narrow.bytes.data(), narrow.scale};
}

/// Measures rows as G reads them with every version. If rows must have length 1, the oracle does
/// not apply, and the result of float32 rows is compared.
template <class G>
void expect_aggregate(const Narrow& narrow, const exact::Judge& judge, exact::Aggregate aggregate,
                      const char* kind) {
    const exact::Case& c = narrow.wide;
    const bool judged = etlmon::distance(c.metric).prepared == etlmon::Prepared::as_given;
    const auto direct = row_versions<G>(c.metric);
    const auto wide = row_versions<const float*>(c.metric);
    for (std::size_t v = 0; v < direct.size(); ++v) {
        const Measured measured = direct[v].measure(c, rows_in(narrow, G{}), aggregate);
        const Measured of_wide = wide[v].measure(c, c.targets.data(), aggregate);
        ASSERT_EQ(bits(measured.delta), bits(of_wide.delta))
            << direct[v].name << ": " << describe(c, aggregate, kind);
        ASSERT_EQ(measured.nearest, of_wide.nearest)
            << direct[v].name << ": " << describe(c, aggregate, kind);
        if (!judged) continue;
        ASSERT_EQ(judge.mismatch(aggregate, bits(measured.delta), measured.nearest), "")
            << direct[v].name << ": " << describe(c, aggregate, kind);
    }
}

/// Tests every size and kind, for rows as G reads them.
template <class G>
void expect_metric(Storage storage, MetricId metric) {
    for (const std::uint32_t dimension : kDimensions) {
        for (const std::uint32_t rows : rows_of(metric, dimension)) {
            for (const Kind kind : kinds_of(metric, rows, dimension)) {
                const Narrow narrow = make_narrow(storage, metric, rows, dimension, kind);
                const exact::Judge judge(narrow.wide, kFlushesDenormals);
                for (const exact::Aggregate aggregate :
                     aggregates(rows, is_heavy(metric, rows, dimension)))
                    expect_aggregate<G>(narrow, judge, aggregate, name(kind));
                if (testing::Test::HasFatalFailure()) return;
            }
        }
    }
}

}  // namespace narrow_cases
