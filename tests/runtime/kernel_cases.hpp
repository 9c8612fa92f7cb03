// Inputs of all kernel tests: sizes, distances, aggregations, and kinds of input.
// Takes: a seed. Gives: cases for exact::mismatch, and the run-time kernel's result for them.
#pragma once

#include <cstdint>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "etlmon/hosted/dynamic.hpp"
#include "exact.hpp"

namespace kernel_cases {

#if defined(__FAST_MATH__)
inline constexpr bool kFlushesDenormals = true;
#else
inline constexpr bool kFlushesDenormals = false;
#endif

inline const std::vector<std::uint32_t> kDimensions{1, 2, 3, 7, 32, 33, 384, 1000};
inline const std::vector<std::uint32_t> kRows{1, 2, 3, 4, 5, 8, 17, 64};

inline std::vector<etlmon::MetricId> metrics() {
    std::vector<etlmon::MetricId> all;
    for (std::size_t i = 0; i < std::size(etlmon::kDistances); ++i)
        all.push_back(static_cast<etlmon::MetricId>(i));
    return all;
}

/// Returns whether matrix products, mainly of the oracle, take most of the time; such sets get
/// fewer kinds of input.
inline bool is_heavy(etlmon::MetricId metric, std::uint32_t rows, std::uint32_t dimension) {
    return metric == etlmon::MetricId::mahalanobis && dimension * rows > 1000;
}

/// Returns the numbers of rows for a dimension. With full weights each row costs D x D
/// multiplications, and as many in the oracle, so there are few of the longest.
inline std::vector<std::uint32_t> rows_of(etlmon::MetricId metric, std::uint32_t dimension) {
    std::vector<std::uint32_t> all;
    for (const std::uint32_t rows : kRows) {
        const bool quadratic = metric == etlmon::MetricId::mahalanobis;
        if (!quadratic || rows <= 2 || rows * dimension * dimension < 1'000'000)
            all.push_back(rows);
    }
    return all;
}

/// Returns whether tests of single elements would take most of the time. Smaller sets show the
/// effects of size as well.
inline bool is_large(std::uint32_t rows, std::uint32_t dimension) {
    return rows * dimension > 4000;
}

/// Returns every aggregation; if it is cheap, also the first and last n of kth.
inline std::vector<exact::Aggregate> aggregates(std::uint32_t rows, bool heavy = false) {
    using Id = etlmon::AggregationId;
    std::vector<exact::Aggregate> all{
        {Id::min, 1}, {Id::max, 1}, {Id::mean, 1}, {Id::kth, (rows + 1) / 2}};
    if (!heavy) all.insert(all.end(), {{Id::kth, 1}, {Id::kth, rows}});
    return all;
}

enum class Kind { ordinary, near_target, touching, equal, huge, tiny, denormal, mixed, opposite };
inline const std::vector<Kind> kKinds{Kind::ordinary, Kind::near_target, Kind::touching,
                                      Kind::equal,    Kind::huge,        Kind::tiny,
                                      Kind::denormal, Kind::mixed,       Kind::opposite};
inline const char* name(Kind kind) {
    static const char* names[] = {"ordinary", "near",     "touching", "equal",   "huge",
                                  "tiny",     "denormal", "mixed",    "opposite"};
    return names[static_cast<int>(kind)];
}

/// Makes rows x dimension targets and a z of that kind; every number is finite.
inline exact::Case make(etlmon::MetricId metric, std::uint32_t rows, std::uint32_t dimension,
                        Kind kind, std::uint32_t seed) {
    std::mt19937 random(seed * 7919 + rows * 131 + dimension);
    std::normal_distribution<float> normal;
    std::uniform_int_distribution<int> power(-30, 30);
    const float scale = kind == Kind::huge       ? 8e37F
                        : kind == Kind::tiny     ? 1e-24F
                        : kind == Kind::denormal ? 1e-41F
                                                 : 1.0F;
    const auto draw = [&] {
        float x = scale * std::min(4.0F, std::max(-4.0F, normal(random)));
        if (kind == Kind::mixed) x = std::ldexp(x, power(random));
        return x == 0 ? scale : x;
    };
    exact::Case c{metric, rows, dimension, {}, {}, {}};
    for (std::uint32_t i = 0; i < rows * dimension; ++i) c.targets.push_back(draw());
    const float* of = c.targets.data() + std::size_t{random() % rows} * dimension;
    for (std::uint32_t i = 0; i < dimension; ++i) {
        switch (kind) {
            case Kind::near_target: c.z.push_back(of[i] * (1 + 1e-4F * normal(random))); break;
            case Kind::touching:
                c.z.push_back(std::nextafter(of[i], normal(random) > 0 ? 10.0F : -10.0F));
                break;
            case Kind::equal: c.z.push_back(of[i]); break;
            case Kind::opposite: c.z.push_back(-of[i] * (1 + 1e-5F * normal(random))); break;
            default: c.z.push_back(draw());
        }
    }
    if (metric == etlmon::MetricId::mahalanobis)
        c.weights = exact::positive_definite(dimension, seed);
    if (metric == etlmon::MetricId::mahalanobis_diagonal) {
        for (std::uint32_t i = 0; i < dimension; ++i)
            c.weights.push_back(0.1F + std::abs(normal(random)));
    }
    return c;
}

inline std::uint32_t bits(const float& x) {
    std::uint32_t b = 0;
    std::memcpy(&b, &x, sizeof b);
    return b;
}

/// Returns the result of the run-time kernel.
etlmon::Measured run(const exact::Case& c, exact::Aggregate aggregate);

inline std::string describe(const exact::Case& c, exact::Aggregate a, const char* kind) {
    static const char* aggregations[] = {"min", "max", "mean", "kth"};
    return std::string(aggregations[static_cast<int>(a.id)]) + "(" + std::to_string(a.n) + ") " +
           etlmon::distance(c.metric).word + ", D " + std::to_string(c.dimension) + ", K " +
           std::to_string(c.rows) + ", " + kind;
}

}  // namespace kernel_cases
