// Distances in double, and the moves of narrow rows, for tests of bounds on distances. Takes: a
// case, and its narrow rows widened to float32. Gives: the aggregated distance by its definition;
// the greatest move of a row in the norm that etlmon/distance/enclosed.hpp requires, rounded up.
// Keeps true: it shares no arithmetic with the kernels; cosine and angular use the chord and
// Kahan's formula, which are exact near 0.
#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "kernel_cases.hpp"

namespace kernel_cases {

/// Returns the distance of two points.
inline double distance_of(const exact::Case& c, const float* g) {
    double l1 = 0, linf = 0, square = 0, z_square = 0, g_square = 0, apart = 0, along = 0;
    for (std::size_t i = 0; i < c.dimension; ++i) {
        const double z = double{c.z[i]}, x = double{g[i]}, e = std::abs(z - x);
        const double w =
            c.metric == etlmon::MetricId::mahalanobis_diagonal ? double{c.weights[i]} : 1.0;
        l1 += e, linf = std::max(linf, e), square += w * e * e;
        z_square += z * z, g_square += x * x;
    }
    for (std::size_t i = 0; i < c.dimension; ++i) {
        const double u = double{c.z[i]} / std::sqrt(z_square),
                     v = double{g[i]} / std::sqrt(g_square);
        apart += (u - v) * (u - v), along += (u + v) * (u + v);
    }
    switch (c.metric) {
        case etlmon::MetricId::l1: return l1;
        case etlmon::MetricId::linf: return linf;
        case etlmon::MetricId::l2sq: return square;
        case etlmon::MetricId::cosine: return apart / 2;
        case etlmon::MetricId::angular: return 2 * std::atan2(std::sqrt(apart), std::sqrt(along));
        default: return std::sqrt(square);
    }
}

inline double aggregated(const exact::Case& c, exact::Aggregate aggregate) {
    std::vector<double> rows;
    for (std::size_t k = 0; k < c.rows; ++k)
        rows.push_back(distance_of(c, c.targets.data() + k * c.dimension));
    if (aggregate.id == etlmon::AggregationId::mean)
        return std::accumulate(rows.begin(), rows.end(), 0.0) / static_cast<double>(rows.size());
    std::sort(rows.begin(), rows.end());
    if (aggregate.id == etlmon::AggregationId::max) return rows.back();
    return rows[aggregate.id == etlmon::AggregationId::kth ? aggregate.n - 1 : 0];
}

/// Computes in double, over rows of length 1 for distances of directions.
inline float greatest_move(const exact::Case& c, const std::vector<float>& narrow) {
    double greatest = 0;
    for (std::size_t k = 0; k < c.rows; ++k) {
        double length = 0;
        for (std::size_t i = 0; i < c.dimension; ++i)
            length += std::pow(double{c.targets[k * c.dimension + i]}, 2);
        const bool unit = etlmon::distance(c.metric).prepared == etlmon::Prepared::unit_rows;
        length = unit ? std::sqrt(length) : 1;
        double l1 = 0, linf = 0, square = 0;
        for (std::size_t i = 0; i < c.dimension; ++i) {
            const std::size_t at = k * c.dimension + i;
            const double e = std::abs(double{narrow[at]} - double{c.targets[at]} / length);
            const double w =
                c.metric == etlmon::MetricId::mahalanobis_diagonal ? double{c.weights[i]} : 1.0;
            l1 += e, linf = std::max(linf, e), square += w * e * e;
        }
        greatest = std::max(greatest, c.metric == etlmon::MetricId::l1     ? l1
                                      : c.metric == etlmon::MetricId::linf ? linf
                                                                           : std::sqrt(square));
    }
    return std::nextafter(static_cast<float>(greatest * (1 + 1e-6)), HUGE_VALF);
}

}  // namespace kernel_cases
